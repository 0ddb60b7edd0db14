#include "renderer/color/srgb.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

using renderer::linear_from_srgb;
using renderer::quantise_8;
using renderer::srgb_from_linear;

TEST(Srgb, HasTheValuesOfTheStandard)
{
    EXPECT_EQ(srgb_from_linear(0), 0);
    EXPECT_EQ(srgb_from_linear(1), 1);
    EXPECT_NEAR(srgb_from_linear(0.0031308f), 0.04045f, 1e-5f);
    EXPECT_NEAR(srgb_from_linear(0.18f), 0.461356f, 1e-5f);
    EXPECT_NEAR(srgb_from_linear(0.5f), 0.735357f, 1e-5f);
    EXPECT_NEAR(linear_from_srgb(0.5f), 0.214041f, 1e-5f);
    EXPECT_EQ(quantise_8(srgb_from_linear(0.5f)), 188);
    EXPECT_EQ(quantise_8(srgb_from_linear(0.2158605f)), 128);
}

TEST(Srgb, GoesThereAndBackForEveryCode)
{
    for (int code = 0; code <= 255; ++code) {
        const float encoded = static_cast<float>(code) / 255;
        EXPECT_EQ(quantise_8(srgb_from_linear(linear_from_srgb(encoded))), code);
    }
}

TEST(Srgb, FindsTheCodeOfEveryNumberWithoutThePower)
{
    const auto same = [](std::uint32_t bits) {
        const auto x = std::bit_cast<float>(bits);
        return renderer::srgb_8_from_linear(x) == quantise_8(srgb_from_linear(x));
    };
    const auto one = std::bit_cast<std::uint32_t>(1.0f);
    for (std::uint32_t bits = 0; bits <= one + 1000; bits += 997)
        ASSERT_TRUE(same(bits)) << bits;
    for (int code = 0; code < 255; ++code) { // the neighbourhood of every step
        const auto step =
            std::bit_cast<std::uint32_t>(linear_from_srgb((static_cast<float>(code) + 0.5f) / 255));
        for (std::uint32_t bits = step - 200; bits <= step + 200; ++bits)
            ASSERT_TRUE(same(bits)) << bits;
    }
    for (const float x : {-1.0f,
                          -0.0f,
                          7.0f,
                          std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()})
        EXPECT_EQ(renderer::srgb_8_from_linear(x), quantise_8(srgb_from_linear(x)));
}

TEST(Srgb, NeverFalls)
{
    float before = 0;
    for (int i = 0; i <= 100000; ++i) {
        const float now = srgb_from_linear(static_cast<float>(i) / 100000);
        ASSERT_GE(now, before);
        before = now;
    }
}

TEST(Srgb, ClampsWhatIsOutsideAndBlackensNaN)
{
    EXPECT_EQ(srgb_from_linear(-1), 0);
    EXPECT_EQ(srgb_from_linear(7), 1);
    EXPECT_EQ(srgb_from_linear(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(quantise_8(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(quantise_8(std::numeric_limits<float>::infinity()), 255);
}
