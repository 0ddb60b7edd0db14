#include "renderer/lights/environment_map.h"
#include "renderer/math/transcendental.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace renderer;

namespace {

// One texel of radiance 1e6 in the dark.
EnvironmentMap hot(std::uint32_t column, std::uint32_t row, double rotation_deg = 0)
{
    std::vector<Rgb> texels(32 * 16);
    texels[row * 32 + column] = {1e6f, 1e6f, 1e6f};
    return {32, 16, texels, rotation_deg};
}

// Integral of radiance times (1 + w . way) over all directions, by what sample() draws.
double gathered(const EnvironmentMap& map, Vec3d way)
{
    double sum = 0;
    const PixelSampler numbers(1, 2, 3);
    constexpr std::uint32_t kSamples = 65536;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const EnvironmentMap::Sample s = map.sample(numbers.sample_2d(i, 0));
        if (s.pdf > 0) sum += static_cast<double>(s.radiance.g) / s.pdf * (1 + dot(s.wi, way));
    }
    return sum / kSamples;
}

} // namespace

TEST(EnvironmentMap, GivesOfAHotTexelItsRadianceTimesItsSolidAngleAlsoAtPoleAndSeam)
{
    for (const std::uint32_t row : {0u, 7u, 15u})
        for (const std::uint32_t column : {0u, 13u, 31u}) {
            const EnvironmentMap map = hot(column, row, 30);
            const double top = std::cos(kPi * row / 16), bottom = std::cos(kPi * (row + 1) / 16);
            const double solid_angle = 2 * kPi / 32 * (top - bottom);
            EXPECT_NEAR(gathered(map, {0, 0, 0}) / (1e6 * solid_angle), 1, 1e-5) << row << " " << column;
            // Its mean height: the mean of the cosine over the patch.
            EXPECT_NEAR(gathered(map, {0, 1, 0}) / (1e6 * solid_angle), 1 + (top + bottom) / 2, 1e-4);
        }
}

TEST(EnvironmentMap, DrawsWithTheDensityThatItTells)
{
    std::vector<Rgb> texels;
    for (std::uint32_t i = 0; i < 32 * 16; ++i)
        texels.push_back({0.1f * static_cast<float>(i % 7), static_cast<float>(i % 5), 0});
    const EnvironmentMap map(32, 16, texels, 77);
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const EnvironmentMap::Sample s = map.sample(PixelSampler(4, i, 1).sample_2d(0, 0));
        ASSERT_GT(s.pdf, 0);
        ASSERT_NEAR(length(s.wi), 1, 1e-12);
        ASSERT_NEAR(map.pdf(s.wi) / s.pdf, 1, 1e-9);
        ASSERT_EQ(map.radiance(s.wi), s.radiance);
    }
}

TEST(EnvironmentMap, LiesAsTheConventionSays)
{
    std::vector<Rgb> texels(64 * 32);
    const auto mark = [&](std::uint32_t x, std::uint32_t y, float value) {
        texels[y * 64 + x] = {value, 0, 0};
    };
    mark(32, 16, 1); // centre: -z, just below the horizon and to the right
    mark(48, 16, 2); // a quarter to the right: +x
    mark(0, 16, 3);  // the seam: +z
    for (std::uint32_t x = 0; x < 64; ++x)
        mark(x, 0, 4);
    const EnvironmentMap map(64, 32, texels, 0);
    EXPECT_EQ(map.radiance(normalize(Vec3d{0.01, -0.01, -1})).r, 1);
    EXPECT_EQ(map.radiance(normalize(Vec3d{1, -0.01, 0.01})).r, 2);
    EXPECT_EQ(map.radiance(normalize(Vec3d{-0.01, -0.01, 1})).r, 3);
    EXPECT_EQ(map.radiance({0, 1, 0}).r, 4);
    // Turned counter-clockwise as seen from above, what was at -z comes to -x.
    const EnvironmentMap turned(64, 32, texels, 90);
    EXPECT_EQ(turned.radiance(normalize(Vec3d{-1, -0.01, -0.01})).r, 1);
}

TEST(EnvironmentMap, InterpolatesAcrossTheSeam)
{
    std::vector<Rgb> texels(8 * 4);
    for (std::uint32_t y = 0; y < 4; ++y)
        texels[y * 8] = {1, 1, 1};
    const EnvironmentMap map(8, 4, texels, 0);
    EXPECT_NEAR(map.interpolated(normalize(Vec3d{0, 0, 1})).r, 0.5f, 1e-6f);
    EXPECT_EQ(map.interpolated(normalize(Vec3d{0, 0, -1})).r, 0);
}

TEST(EnvironmentMap, OfNothingIsNeverDrawnFrom)
{
    const EnvironmentMap map(4, 2, std::vector<Rgb>(8), 0);
    EXPECT_EQ(map.sample({0.5f, 0.5f}).pdf, 0);
    EXPECT_EQ(map.pdf({0, 1, 0}), 0);
}
