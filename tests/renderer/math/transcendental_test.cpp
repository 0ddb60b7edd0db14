#include "renderer/math/transcendental.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace {

// Distance in units of the last place of the true value.
double ulps(double got, long double want)
{
    const double rounded = static_cast<double>(want);
    const double ulp = std::nextafter(std::abs(rounded), INFINITY) - std::abs(rounded);
    return static_cast<double>(std::abs(static_cast<long double>(got) - want)) / ulp;
}

// A plain generator: values only have to be spread, and the same every run.
double spread(std::uint64_t i)
{
    return static_cast<double>((i * 0x9E3779B97F4A7C15ull) >> 11) * 0x1p-53;
}

constexpr long double kPiLong = 3.14159265358979323846264338327950288L;

} // namespace

TEST(SinCosDeg, IsExactAtMultiplesOfNinety)
{
    const double want[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (int k = -8; k <= 8; ++k) {
        const auto [s, c] = renderer::sin_cos_deg(90.0 * k);
        EXPECT_EQ(s, want[k & 3][0]) << k;
        EXPECT_EQ(c, want[k & 3][1]) << k;
    }
}

TEST(SinCosDeg, IsWithinTwoUlpOfTheTrueValue)
{
    for (std::uint64_t i = 0; i < 200000; ++i) {
        const double degrees = (spread(i) - 0.5) * 1440;
        const long double quarters = std::rint(static_cast<long double>(degrees) / 90);
        const long double rest =
            (degrees - 90 * quarters) * kPiLong / 180; // exact difference: true near the zeros too
        const long double sines[4] = {std::sin(rest), std::cos(rest), -std::sin(rest), -std::cos(rest)};
        const auto [s, c] = renderer::sin_cos_deg(degrees);
        ASSERT_LE(ulps(s, sines[static_cast<int>(quarters) & 3]), 2) << degrees;
        ASSERT_LE(ulps(c, sines[(static_cast<int>(quarters) + 1) & 3]), 2) << degrees;
    }
}

TEST(SinCos, IsWithinTwoUlpOfTheTrueValue)
{
    for (std::uint64_t i = 0; i < 200000; ++i) {
        const double radians = (spread(i) - 0.5) * (i % 2 == 0 ? 20 : 2e5);
        const auto [s, c] = renderer::sin_cos(radians);
        ASSERT_LE(ulps(s, std::sin(static_cast<long double>(radians))), 2) << radians;
        ASSERT_LE(ulps(c, std::cos(static_cast<long double>(radians))), 2) << radians;
    }
}

TEST(SinCos, KeepsNaN)
{
    EXPECT_TRUE(std::isnan(renderer::sin_cos_deg(NAN).first));
    EXPECT_TRUE(std::isnan(renderer::sin_cos_deg(INFINITY).second));
}

TEST(TanDeg, HoldsAtTheNarrowestAndTheWidestFieldOfView)
{
    EXPECT_LE(ulps(renderer::tan_deg(0.005), std::tan(0.005L * kPiLong / 180)), 3);
    EXPECT_LE(ulps(renderer::tan_deg(45), 1), 2);
    const long double near_right_angle = static_cast<long double>(89.95); // what the double is, not 89.95
    EXPECT_LE(ulps(renderer::tan_deg(89.95), std::tan(near_right_angle * kPiLong / 180)), 3);
}

TEST(Exp2, IsExactAtIntegersAndWithinTwoUlpBetween)
{
    for (int n = -1000; n <= 1000; n += 50)
        EXPECT_EQ(renderer::exp2(n), std::ldexp(1.0, n));
    for (std::uint64_t i = 0; i < 100000; ++i) {
        const double x = (spread(i) - 0.5) * 40;
        ASSERT_LE(ulps(renderer::exp2(x), std::exp2(static_cast<long double>(x))), 2) << x;
    }
}

TEST(Log2, IsWithinThreeUlpAndExactAtPowersOfTwo)
{
    for (int exponent = -1074; exponent <= 1023; ++exponent) {
        ASSERT_EQ(renderer::log2(std::ldexp(1.0, exponent)), exponent);
    }
    for (std::uint64_t i = 1; i < 200000; ++i) {
        const double x = std::ldexp(0.5 + spread(i) / 2, static_cast<int>(i % 400) - 200);
        const long double want = std::log2(static_cast<long double>(x));
        ASSERT_LE(ulps(renderer::log2(x), want), 3) << x;
        const double near_one = 1 + (spread(i) - 0.5) / 8;
        ASSERT_NEAR(renderer::log2(near_one),
                    static_cast<double>(std::log2(static_cast<long double>(near_one))),
                    1e-16);
    }
    EXPECT_EQ(renderer::log2(0), -INFINITY);
    EXPECT_EQ(renderer::log2(INFINITY), INFINITY);
    EXPECT_TRUE(std::isnan(renderer::log2(-1)));
    EXPECT_TRUE(std::isnan(renderer::log2(NAN)));
}

TEST(Exp, IsWithinTwoUlpOfTheTrueValue)
{
    for (std::uint64_t i = 0; i < 200000; ++i) {
        const double x = (spread(i) - 0.5) * (i % 2 == 0 ? 2 : 1400);
        ASSERT_LE(ulps(renderer::exp(x), std::exp(static_cast<long double>(x))), 2) << x;
    }
    EXPECT_EQ(renderer::exp(0), 1);
    EXPECT_EQ(renderer::exp(-1e9), 0);
    EXPECT_EQ(renderer::exp(1e9), std::numeric_limits<double>::infinity());
    EXPECT_EQ(renderer::exp(-std::numeric_limits<double>::infinity()), 0);
    EXPECT_TRUE(std::isnan(renderer::exp(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Atan2, IsWithinThreeUlpOfTheTrueValueInEveryQuarter)
{
    for (std::uint64_t i = 0; i < 200000; ++i) {
        const double x = spread(2 * i) - 0.5, y = (spread(2 * i + 1) - 0.5) * (i % 3 == 0 ? 1e-9 : 1);
        ASSERT_LE(
            ulps(renderer::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))),
            3)
            << y << " " << x;
    }
    EXPECT_EQ(renderer::atan2(0, 0), 0);
    EXPECT_EQ(renderer::atan2(0, 1), 0);
    EXPECT_EQ(renderer::atan2(0, -1), renderer::kPi);
    EXPECT_EQ(renderer::atan2(1, 0), renderer::kPi / 2);
    EXPECT_EQ(renderer::atan2(-1, 0), -renderer::kPi / 2);
    EXPECT_TRUE(std::isnan(renderer::atan2(std::numeric_limits<double>::quiet_NaN(), 1)));
}

TEST(Acos, IsTrueToTheLastDigitsAlsoNearOneAndMinusOne)
{
    for (const double c : {-1.0, -0.999999999, -0.5, 0.0, 0.3, 0.999999999999, 1.0})
        EXPECT_NEAR(renderer::acos(c), static_cast<double>(std::acos(static_cast<long double>(c))), 1e-15)
            << c;
    EXPECT_EQ(renderer::acos(2), 0);
    EXPECT_EQ(renderer::acos(-2), renderer::kPi);
}

TEST(SinCos, NearZeroNeedsNoReduction)
{
    for (int i = -1000; i <= 1000; ++i) {
        const double x = renderer::kPi / 4 * i / 1000;
        const auto [s, c] = renderer::sin_cos_near_zero(x);
        EXPECT_DOUBLE_EQ(s, renderer::sin_cos(x).first) << x;
        EXPECT_DOUBLE_EQ(c, renderer::sin_cos(x).second) << x;
    }
}
