#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"
#include "tests/support/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

using renderer::Frame;
using renderer::PixelSampler;
using renderer::Vec3f;

namespace {

// Plain pseudo-random pairs: chi-square wants independent draws, which stratified ones are not.
renderer::Sample2 independent(std::size_t i)
{
    return PixelSampler(17, static_cast<std::uint32_t>(i), 5).sample_2d(0, 0);
}

constexpr double kSidak = 0.01 / 8; // tests in this file

} // namespace

TEST(CosineHemisphere, DrawsAsItsDensitySays)
{
    const auto result = tests::chi_square(
        500000,
        [](std::size_t i) { return renderer::sample_cosine_hemisphere(independent(i)); },
        [](Vec3f w) { return static_cast<double>(renderer::pdf_cosine_hemisphere(w.z)); });
    EXPECT_NEAR(result.expected_share, 1, 1e-3);
    EXPECT_NEAR(result.drawn_share, 1, 1e-9);
    EXPECT_GT(result.p_value, kSidak) << result.statistic << " for " << result.degrees;
}

TEST(PowerLobe, DrawsAsItsDensitySays)
{
    for (const double exponent : {0.0, 0.5, 1.0, 10.0, 100.0, 1000.0}) {
        const auto result = tests::chi_square(
            500000,
            [&](std::size_t i) { return renderer::sample_power_lobe(independent(i), exponent); },
            [&](Vec3f w) { return renderer::pdf_power_lobe(1 - static_cast<double>(w.z), exponent); },
            60);
        EXPECT_NEAR(result.expected_share, 1, 2e-3) << exponent;
        EXPECT_GT(result.p_value, kSidak)
            << exponent << ": " << result.statistic << " for " << result.degrees;
    }
}

TEST(ChiSquare, RejectsAWrongDensity)
{
    const auto result = tests::chi_square(
        500000,
        [](std::size_t i) { return renderer::sample_cosine_hemisphere(independent(i)); },
        [](Vec3f w) { return w.z > 0 ? 1 / (2 * renderer::kPi) : 0.0; });
    EXPECT_LT(result.p_value, 1e-6);
}

TEST(PowerOfCosine, KeepsItsDigitsForNarrowLobes)
{
    for (const double exponent : {1.0, 32.0, 1e3, 1e6})
        for (const double off : {0.0, 1e-12, 1e-9, 1e-6, 9.9e-5, 1.01e-4, 1e-3, 0.1, 0.5, 0.999}) {
            const double want = static_cast<double>(
                std::exp(static_cast<long double>(exponent) * std::log1p(static_cast<long double>(-off))));
            EXPECT_NEAR(renderer::power_of_cosine(off, exponent), want, 1e-9 * want + 1e-300)
                << exponent << " " << off;
        }
    EXPECT_EQ(renderer::power_of_cosine(1, 5), 0);
    EXPECT_EQ(renderer::power_of_cosine(2, 5), 0);
    EXPECT_EQ(renderer::power_of_cosine(0.5, 0), 1);
}

TEST(Frame, IsOrthonormalAndRightHandedAroundEveryNormal)
{
    for (std::uint32_t i = 0; i < 10000; ++i) {
        const Vec3f hemisphere = renderer::sample_cosine_hemisphere(independent(i));
        const Vec3f n = (i & 1) != 0 ? hemisphere : -hemisphere;
        const Frame f(n);
        EXPECT_NEAR(dot(f.x, f.y), 0, 1e-6);
        EXPECT_NEAR(dot(f.x, f.z), 0, 1e-6);
        EXPECT_NEAR(dot(f.y, f.z), 0, 1e-6);
        EXPECT_NEAR(length(f.x), 1, 1e-6);
        EXPECT_NEAR(dot(cross(f.x, f.y), f.z), 1, 1e-6);
        EXPECT_EQ(f.z, n);
    }
    for (const Vec3f n : {Vec3f{0, 0, 1}, Vec3f{0, 0, -1}, Vec3f{0, -1, 0}, Vec3f{1, 0, -0.0f}})
        EXPECT_NEAR(dot(cross(Frame(n).x, Frame(n).y), n), 1, 1e-6);
}
