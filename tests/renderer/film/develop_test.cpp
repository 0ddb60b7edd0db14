#include "renderer/film/develop.h"

#include <gtest/gtest.h>

#include <limits>

using renderer::ImageSettings;
using renderer::LinearImage;
using renderer::Tone;

namespace {

LinearImage one_pixel(float r, float g, float b)
{
    return {1, 1, {{r, g, b}}};
}

} // namespace

TEST(Develop, AppliesExposureThenTone)
{
    ImageSettings settings;
    EXPECT_EQ(develop(one_pixel(0.5f, 1, 2), settings).rgb, (std::vector<std::uint8_t>{188, 255, 255}));
    settings.exposure_ev = -1;
    EXPECT_EQ(develop(one_pixel(1, 2, 0), settings).rgb, (std::vector<std::uint8_t>{188, 255, 0}));
    settings.tone = Tone::linear;
    EXPECT_EQ(develop(one_pixel(1, 0.5f, 4), settings).rgb, (std::vector<std::uint8_t>{128, 64, 255}));
}

TEST(Develop, SurvivesValuesThatAreNoColours)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const Tone tone : {Tone::srgb, Tone::linear, Tone::filmic}) {
        ImageSettings settings;
        settings.exposure_ev = 1e300;
        settings.tone = tone;
        EXPECT_EQ(develop(one_pixel(nan, inf, -1), settings).rgb, (std::vector<std::uint8_t>{0, 0, 0}));
        EXPECT_EQ(develop(one_pixel(1, 1e38f, 1e-38f), settings).rgb,
                  (std::vector<std::uint8_t>{255, 255, 255}));
    }
}

TEST(Develop, HasSixteenBitsThatRoundToTheEight)
{
    for (const Tone tone : {Tone::srgb, Tone::linear, Tone::filmic})
        for (float x = 0; x < 1.2f; x += 0.0013f) {
            const auto fine = develop_16(one_pixel(x, x, x), 0, tone);
            const auto coarse = develop_8(one_pixel(x, x, x), 0, tone);
            EXPECT_NEAR(fine.rgb[0] / 257.0, coarse.rgb[0], 0.5 + 1.0 / 257) << x;
            EXPECT_EQ(fine.srgb, tone != Tone::linear);
        }
    EXPECT_EQ(develop_16(one_pixel(0, 1, 0.5f), 0, Tone::linear).rgb,
              (std::vector<std::uint16_t>{0, 65535, 32768}));
    EXPECT_EQ(develop_16(one_pixel(0, 1, 0.5f), 0, Tone::srgb).rgb,
              (std::vector<std::uint16_t>{0, 65535, 48192})); // 0.735357
}
