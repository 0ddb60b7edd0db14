#include "renderer/color/srgb.h"

#include "renderer/math/transcendental.h"

#include <array>
#include <bit>
#include <cmath>

namespace renderer {

namespace {

float clamp_unit(float x)
{
    return x > 0 ? (x < 1 ? x : 1.0f) : 0.0f; // NaN fails the first comparison
}

// The 8-bit code as a table over the leading bits of the number, and the step to the next code.
class CodeTable {
public:
    CodeTable()
    {
        least_[256] = 2.0f; // no number reaches it
        for (std::uint32_t code = 0; code < 256; ++code)
            least_[code] = least_with(code);
        for (std::uint32_t i = 0; i < codes_.size(); ++i)
            codes_[i] = quantise_8(srgb_from_linear(std::bit_cast<float>(kFirst + (i << kShift))));
    }

    std::uint8_t code(float x) const
    {
        const auto bits = std::bit_cast<std::uint32_t>(x);
        std::uint32_t code = bits < kFirst ? 0 : codes_[(bits - kFirst) >> kShift];
        while (x >= least_[code + 1])
            ++code;
        return static_cast<std::uint8_t>(code);
    }

private:
    static constexpr std::uint32_t kShift = 16;                            // 128 entries an octave
    static constexpr auto kFirst = std::bit_cast<std::uint32_t>(0x1p-13f); // below half of code 1
    static constexpr auto kLast = std::bit_cast<std::uint32_t>(1.0f);

    // The transfer function never falls (a test), so its steps can be bisected.
    static float least_with(std::uint32_t code)
    {
        std::uint32_t low = 0, high = kLast; // bits of numbers that are not negative order as the numbers do
        while (low < high) {
            const std::uint32_t middle = low + (high - low) / 2;
            if (quantise_8(srgb_from_linear(std::bit_cast<float>(middle))) >= code)
                high = middle;
            else
                low = middle + 1;
        }
        return std::bit_cast<float>(low);
    }

    std::array<float, 257> least_{};
    std::array<std::uint8_t, ((kLast - kFirst) >> kShift) + 1> codes_{};
};

} // namespace

float srgb_from_linear(float linear)
{
    const float x = clamp_unit(linear);
    if (x <= 0.0031308f) return 12.92f * x;
    // In double, so that 1 stays 1.
    return clamp_unit(static_cast<float>(1.055 * static_cast<double>(pow(x, 1.0f / 2.4f)) - 0.055));
}

float linear_from_srgb(float encoded)
{
    const float x = clamp_unit(encoded);
    return x <= 0.04045f ? x / 12.92f : clamp_unit(pow((x + 0.055f) / 1.055f, 2.4f));
}

std::uint8_t quantise_8(float value)
{
    return static_cast<std::uint8_t>(std::lround(clamp_unit(value) * 255.0f));
}

std::uint16_t quantise_16(float value)
{
    return static_cast<std::uint16_t>(std::lround(clamp_unit(value) * 65535.0f));
}

std::uint16_t srgb_16_from_linear(float linear)
{
    return quantise_16(srgb_from_linear(linear));
}

std::uint8_t srgb_8_from_linear(float linear)
{
    static const CodeTable table;
    return table.code(clamp_unit(linear));
}

} // namespace renderer
