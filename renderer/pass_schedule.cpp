#include "renderer/pass_schedule.h"

#include <algorithm>

namespace renderer {

namespace {

constexpr std::uint32_t kSlice = 4, kLargestPass = 16;

// The first passes double what there is: the end of pass 0, 1, 2, 3, 4 is 1, 2, 4, 8, 16.
std::uint64_t end_of_pass(std::uint64_t pass)
{
    return pass < 5 ? std::uint64_t{1} << pass : kLargestPass * (pass - 3);
}

} // namespace

SampleRange samples_of_pass(std::uint32_t pass)
{
    const auto clamped = [](std::uint64_t sample) {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(sample, 0xffffffffu));
    };
    return {pass == 0 ? 0 : clamped(end_of_pass(pass - 1)), clamped(end_of_pass(pass))};
}

SampleRange samples_of_slice(std::uint32_t slice)
{
    if (slice < 3) return samples_of_pass(slice);
    const std::uint32_t first = kSlice * (slice - 2);
    return {first, first + kSlice};
}

std::uint32_t slice_number(std::uint32_t samples)
{
    if (samples <= kSlice) return samples <= 2 ? samples : 3;
    return 2 + (samples - 1) / kSlice + 1;
}

std::uint32_t passes_for(std::uint32_t samples)
{
    std::uint32_t passes = 0;
    while (passes < 5 && samples_of_pass(passes).first < samples)
        ++passes;
    if (samples > kLargestPass) passes = 5 + (samples - kLargestPass + kLargestPass - 1) / kLargestPass;
    return passes;
}

} // namespace renderer
