#include "renderer/sampling/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

using renderer::PixelSampler;
using renderer::Sample2;

namespace {

// Sobol's second dimension by its direction numbers, as every textbook has it.
std::uint32_t second_coordinate(std::uint32_t index)
{
    std::uint32_t v = 1u << 31, x = 0;
    for (; index != 0; index >>= 1, v ^= v >> 1)
        if ((index & 1) != 0) x ^= v;
    return x;
}

// How many of the `strata` equal parts of [0,1) hold exactly one of the numbers.
std::size_t filled_strata(const std::vector<float>& numbers)
{
    std::set<std::size_t> strata;
    for (const float u : numbers)
        strata.insert(static_cast<std::size_t>(u * static_cast<float>(numbers.size())));
    return strata.size();
}

double correlation(const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += (a[i] - 0.5) * (b[i] - 0.5);
    return sum / static_cast<double>(a.size()) * 12;
}

} // namespace

TEST(Sobol, EqualsItsDirectionNumbers)
{
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const std::uint32_t index = i * 2654435761u;
        ASSERT_EQ(renderer::sobol_2d(index).y, second_coordinate(index)) << index;
    }
}

TEST(OwenScramble, IsAPermutationOfEveryElementaryInterval)
{
    // Fractions with equal leading bits stay together: scrambling never breaks a stratum.
    for (const std::uint32_t seed : {0u, 1u, 0x9e3779b9u, 0xffffffffu})
        for (unsigned bits = 1; bits <= 10; ++bits) {
            std::set<std::uint32_t> images;
            for (std::uint32_t i = 0; i < (1u << bits); ++i) {
                const std::uint32_t low = renderer::owen_scramble(i << (32 - bits), seed) >> (32 - bits);
                const std::uint32_t high =
                    renderer::owen_scramble((i << (32 - bits)) | ((1u << (32 - bits)) - 1), seed) >>
                    (32 - bits);
                EXPECT_EQ(low, high);
                images.insert(low);
            }
            EXPECT_EQ(images.size(), std::size_t{1} << bits);
        }
}

TEST(PixelSampler, StratifiesEveryProjectionOfEveryPowerOfTwoPrefix)
{
    for (std::uint32_t pixel = 0; pixel < 50; ++pixel) {
        const PixelSampler sampler(pixel * 77, pixel, 3 * pixel);
        for (std::uint32_t n = 2; n <= 1024; n *= 2)
            for (std::uint32_t dimension = 0; dimension < 4; ++dimension) {
                std::vector<float> one, x, y;
                for (std::uint32_t s = 0; s < n; ++s) {
                    one.push_back(sampler.sample_1d(s, dimension));
                    const Sample2 u = sampler.sample_2d(s, dimension);
                    x.push_back(u.u0);
                    y.push_back(u.u1);
                }
                ASSERT_EQ(filled_strata(one), n);
                ASSERT_EQ(filled_strata(x), n);
                ASSERT_EQ(filled_strata(y), n);
            }
    }
}

TEST(PixelSampler, StratifiesPairsInSquaresToo)
{
    const PixelSampler sampler(5, 10, 20);
    for (std::uint32_t root = 2; root <= 32; root *= 2) {
        std::set<std::uint32_t> cells;
        for (std::uint32_t s = 0; s < root * root; ++s) {
            const Sample2 u = sampler.sample_2d(s, 1);
            const auto side = static_cast<float>(root);
            cells.insert(static_cast<std::uint32_t>(u.u0 * side) * root +
                         static_cast<std::uint32_t>(u.u1 * side));
        }
        EXPECT_EQ(cells.size(), root * root);
    }
}

TEST(PixelSampler, StaysBelowOne)
{
    const PixelSampler sampler(1, 0, 0);
    for (std::uint32_t s = 0; s < 200000; ++s) {
        const float u = sampler.sample_1d(s, 0);
        ASSERT_TRUE(u >= 0 && u < 1) << u;
    }
}

TEST(PixelSampler, GivesUncorrelatedDimensionsPixelsAndSeeds)
{
    constexpr std::uint32_t kPixels = 20000;
    // Sample 0 alone of many pixels: where a weak hash would show.
    std::vector<double> a, b, neighbour, other_seed, second;
    for (std::uint32_t i = 0; i < kPixels; ++i) {
        const std::uint32_t x = i % 200, y = i / 200;
        a.push_back(static_cast<double>(PixelSampler(1, x, y).sample_2d(0, 0).u0));
        second.push_back(static_cast<double>(PixelSampler(1, x, y).sample_2d(0, 0).u1));
        b.push_back(static_cast<double>(PixelSampler(1, x, y).sample_2d(0, 1).u0));
        neighbour.push_back(static_cast<double>(PixelSampler(1, x + 1, y).sample_2d(0, 0).u0));
        other_seed.push_back(static_cast<double>(PixelSampler(2, x, y).sample_2d(0, 0).u0));
    }
    const double limit = 5 / std::sqrt(static_cast<double>(kPixels));
    for (const auto* const other : {&b, &neighbour, &other_seed, &second})
        EXPECT_LT(std::abs(correlation(a, *other)), limit);
    double mean = 0;
    for (const double u : a)
        mean += u / kPixels;
    EXPECT_NEAR(mean, 0.5, 5 / std::sqrt(12.0 * kPixels));
}

TEST(PixelSampler, PairsDimensionsIndependentlyWithinAPixel)
{
    // Cells of (dimension 0, dimension 2) over many samples: no cell stays empty or gets far more than its
    // share.
    const PixelSampler sampler(9, 4, 4);
    constexpr std::uint32_t kSide = 16, kSamples = 1 << 16;
    std::vector<double> cells(kSide * kSide);
    for (std::uint32_t s = 0; s < kSamples; ++s) {
        const auto x = static_cast<std::uint32_t>(sampler.sample_1d(s, 0) * kSide);
        const auto y = static_cast<std::uint32_t>(sampler.sample_1d(s, 2) * kSide);
        ++cells[x * kSide + y];
    }
    for (const double count : cells)
        EXPECT_NEAR(count, kSamples / (kSide * kSide), 6 * 16);
}

TEST(PixelSampler, DoesNotRepeatWithinMillionSamples)
{
    // 2^20 numbers of 24 bits that are stratified: every 2^-20 interval holds exactly one.
    const PixelSampler sampler(3, 8191, 8191);
    std::vector<bool> seen(1 << 20);
    for (std::uint32_t s = 0; s < (1u << 20); ++s) {
        const auto cell = static_cast<std::size_t>(sampler.sample_1d(s, 1) * static_cast<float>(1 << 20));
        ASSERT_FALSE(seen[cell]);
        seen[cell] = true;
    }
}
