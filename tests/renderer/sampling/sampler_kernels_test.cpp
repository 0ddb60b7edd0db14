// Every kernel that this processor can run: the same pairs as drawn one by one.
#include "renderer/sampling/sampler_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using namespace renderer;

struct Asked {
    PixelSampler sampler;
    std::uint32_t sample, dimension;
};

std::vector<Asked> questions()
{
    std::vector<Asked> asked;
    for (const std::uint32_t sample : {0u, 1u, 2u, 255u, 65536u, 0x80000000u, 0xffffffffu})
        for (const std::uint32_t dimension : {0u, 1u, 64u, 4095u, 0xffffffffu})
            for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{7}, ~std::uint64_t{0}})
                asked.push_back({PixelSampler(seed, sample ^ 3u, dimension + 5u), sample, dimension});
    return asked;
}

} // namespace

TEST(SamplerKernels, DrawAsOneByOneToTheBit)
{
    const std::vector<Asked> asked = questions();
    for (const DrawPairs kernel : all_draw_pairs())
        for (std::size_t first = 0; first < asked.size(); first += PairRun::kPairs) {
            const std::size_t count = std::min(PairRun::kPairs, asked.size() - first);
            PairRun run{};
            for (std::size_t i = 0; i < count; ++i)
                run.set(i, asked[first + i].sampler, asked[first + i].sample, asked[first + i].dimension);
            std::vector<Sample2> drawn(count);
            kernel(run, drawn);
            for (std::size_t i = 0; i < count; ++i) {
                const Asked& one = asked[first + i];
                const Sample2 expected = one.sampler.sample_2d(one.sample, one.dimension);
                ASSERT_EQ(drawn[i].u0, expected.u0) << one.sample << ' ' << one.dimension;
                ASSERT_EQ(drawn[i].u1, expected.u1) << one.sample << ' ' << one.dimension;
            }
        }
}

TEST(SamplerKernels, WriteAsManyAsThereAre)
{
    for (const DrawPairs kernel : all_draw_pairs())
        for (std::size_t count = 0; count < 20; ++count) {
            std::vector<Sample2> drawn(20, {7, 7});
            kernel(PairRun{}, std::span(drawn).first(count));
            EXPECT_EQ(std::ranges::count(drawn, 7.0f, &Sample2::u0), static_cast<std::ptrdiff_t>(20 - count));
        }
}
