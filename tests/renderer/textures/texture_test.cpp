#include "renderer/color/srgb.h"
#include "renderer/textures/texture.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace {

using renderer::Image;
using renderer::PixelType;
using renderer::Rgba;
using renderer::Texture;
using renderer::TextureEncoding;
using renderer::TextureFilter;
using renderer::TextureFootprint;
using renderer::TextureWrap;

std::shared_ptr<const Image>
codes(std::uint32_t width, std::uint32_t height, std::uint32_t channels, const std::vector<int>& values)
{
    auto image = std::make_shared<Image>(Image{width, height, channels, PixelType::whole_8, {}});
    for (const int value : values)
        image->bytes.push_back(static_cast<std::byte>(value));
    EXPECT_EQ(renderer::validate_image(*image), std::nullopt);
    return image;
}

std::shared_ptr<const Image>
light(std::uint32_t width, std::uint32_t height, const std::vector<float>& values)
{
    auto image = std::make_shared<Image>(Image{width, height, 1, PixelType::real_32, {}});
    image->bytes.append(std::as_bytes(std::span(values)));
    EXPECT_EQ(renderer::validate_image(*image), std::nullopt);
    return image;
}

float red(const Texture& texture,
          double u,
          double v,
          TextureWrap wrap = TextureWrap::repeat,
          TextureFilter filter = TextureFilter::linear,
          const TextureFootprint& footprint = {})
{
    return texture.lookup({u, v}, wrap, filter, footprint).color.r;
}

// 4 x 2, grey: 0 1 2 3 above, 4 5 6 7 below.
Texture steps(TextureFilter filter = TextureFilter::linear)
{
    return {light(4, 2, {0, 1, 2, 3, 4, 5, 6, 7}), TextureEncoding::linear, filter == TextureFilter::linear};
}

TEST(Texture, HasItsFirstRowOnTop)
{
    const Texture texture = steps(TextureFilter::nearest);
    EXPECT_EQ(red(texture, 0.1, 0.9, TextureWrap::repeat, TextureFilter::nearest), 0);
    EXPECT_EQ(red(texture, 0.9, 0.9, TextureWrap::repeat, TextureFilter::nearest), 3);
    EXPECT_EQ(red(texture, 0.1, 0.1, TextureWrap::repeat, TextureFilter::nearest), 4);
}

TEST(Texture, GivesATexelAtItsMiddleAndIsStraightBetween)
{
    const Texture texture = steps();
    EXPECT_FLOAT_EQ(red(texture, 0.375, 0.75), 1);
    EXPECT_FLOAT_EQ(red(texture, 0.5, 0.75), 1.5f);
    EXPECT_FLOAT_EQ(red(texture, 0.375, 0.5), 3);
}

TEST(Texture, WrapsAsItIsAsked)
{
    const Texture texture = steps();
    EXPECT_FLOAT_EQ(red(texture, 0, 0.75, TextureWrap::repeat), 1.5f); // halfway from 3 to 0
    EXPECT_FLOAT_EQ(red(texture, 0, 0.75, TextureWrap::clamp), 0);
    EXPECT_FLOAT_EQ(red(texture, 0, 0.75, TextureWrap::mirror), 0);
    EXPECT_FLOAT_EQ(red(texture, 1.375, 0.75, TextureWrap::repeat), 1);
    EXPECT_FLOAT_EQ(red(texture, -0.625, 0.75, TextureWrap::repeat), 1);
    EXPECT_FLOAT_EQ(red(texture, 1.375, 0.75, TextureWrap::clamp), 3);
    EXPECT_FLOAT_EQ(red(texture, 1.375, 0.75, TextureWrap::mirror), 2);
    EXPECT_FLOAT_EQ(red(texture, -0.375, 0.75, TextureWrap::mirror), 1);
    EXPECT_FLOAT_EQ(red(texture, 2.375, 0.75, TextureWrap::mirror), 1);
}

TEST(Texture, TakesCodesAsLightOrAsSrgb)
{
    const auto image = codes(1, 1, 3, {188, 0, 255});
    EXPECT_FLOAT_EQ(red({image, TextureEncoding::linear, true}, 0.5, 0.5), 188 / 255.0f);
    EXPECT_FLOAT_EQ(red({image, TextureEncoding::srgb, true}, 0.5, 0.5),
                    renderer::linear_from_srgb(188 / 255.0f));
}

TEST(Texture, DecodesSixteenBits)
{
    auto image = std::make_shared<Image>(Image{1, 1, 1, PixelType::whole_16, {}});
    const std::uint16_t code = 40000;
    image->bytes.append(std::as_bytes(std::span(&code, 1)));
    EXPECT_FLOAT_EQ(red({image, TextureEncoding::linear, true}, 0.5, 0.5), 40000 / 65535.0f);
    EXPECT_FLOAT_EQ(red({image, TextureEncoding::srgb, true}, 0.5, 0.5),
                    renderer::linear_from_srgb(40000 / 65535.0f));
}

TEST(Texture, NeverDecodesAlpha)
{
    const Texture texture({codes(1, 1, 2, {100, 188}), TextureEncoding::srgb, true});
    const Rgba found = texture.lookup({0.5, 0.5}, TextureWrap::repeat, TextureFilter::linear, {});
    EXPECT_FLOAT_EQ(found.alpha, 188 / 255.0f);
    EXPECT_EQ(found.color.r, found.color.g);
    EXPECT_EQ(found.color.r, found.color.b);
}

// Light is averaged, not codes: half black and half white is 0.5, whose code is 188.
TEST(Texture, SeesTheMeanInLinearLightWhereAPixelCoversAll)
{
    const TextureFootprint all{{4, 0}, {0, 4}};
    const Texture checker({codes(2, 2, 1, {0, 255, 255, 0}), TextureEncoding::srgb, true});
    EXPECT_NEAR(red(checker, 0.3, 0.7, TextureWrap::repeat, TextureFilter::linear, all), 0.5, 0.003);
    EXPECT_FLOAT_EQ(red(steps(), 0.3, 0.7, TextureWrap::repeat, TextureFilter::linear, all), 3.5f);
}

TEST(Texture, KeepsTheMeanThroughLevelsOfOddSizes)
{
    std::vector<float> values;
    double sum = 0;
    for (int i = 0; i < 7 * 5; ++i) {
        values.push_back(static_cast<float>(i * i % 17));
        sum += i * i % 17;
    }
    const Texture texture({light(7, 5, values), TextureEncoding::linear, true});
    const TextureFootprint all{{9, 0}, {0, 9}};
    EXPECT_NEAR(red(texture, 0.5, 0.5, TextureWrap::clamp, TextureFilter::linear, all), sum / 35, 1e-5);
}

// Stripes along v, seen at a slant along v: still sharp across.
TEST(Texture, StaysSharpAcrossALongFootprint)
{
    std::vector<float> values;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            values.push_back(x < 32 ? 0.0f : 1.0f);
    const Texture texture({light(64, 64, values), TextureEncoding::linear, true});
    const TextureFootprint slanted{{0, 8 / 64.0}, {1 / 64.0, 0}};
    EXPECT_EQ(red(texture, 0.46, 0.5, TextureWrap::clamp, TextureFilter::linear, slanted), 0);
    EXPECT_EQ(red(texture, 0.54, 0.5, TextureWrap::clamp, TextureFilter::linear, slanted), 1);
    const TextureFootprint round{{0, 8 / 64.0}, {8 / 64.0, 0}};
    EXPECT_GT(red(texture, 0.46, 0.5, TextureWrap::clamp, TextureFilter::linear, round), 0.05f);
}

TEST(Texture, ChangesWithoutAStepFromLevelToLevel)
{
    std::vector<float> values;
    for (int i = 0; i < 32 * 32; ++i)
        values.push_back(static_cast<float>((i * 7919) % 101) / 101);
    const Texture texture({light(32, 32, values), TextureEncoding::linear, true});
    float before = red(texture, 0.3, 0.3);
    for (double width = 0.001; width < 3; width *= 1.01) {
        const float now =
            red(texture, 0.3, 0.3, TextureWrap::repeat, TextureFilter::linear, {{width, 0}, {0, width}});
        EXPECT_NEAR(now, before, 0.04) << width;
        before = now;
    }
}

TEST(Texture, AnswersForWhatIsNotFinite)
{
    const double infinite = std::numeric_limits<double>::infinity(),
                 none = std::numeric_limits<double>::quiet_NaN();
    for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::clamp, TextureWrap::mirror})
        for (const double u : {infinite, -infinite, none, 1e300, -1e300})
            for (const double width : {0.0, 1e-300, 1e300, infinite, none}) {
                const float found =
                    red(steps(), u, u, wrap, TextureFilter::linear, {{width, width}, {width, 0}});
                EXPECT_GE(found, 0);
                EXPECT_LE(found, 7);
            }
}

TEST(Texture, KeepsCodesOfEightBitsCompact)
{
    const Texture texture({codes(64, 64, 3, std::vector<int>(64 * 64 * 3, 9)), TextureEncoding::srgb, true});
    EXPECT_LT(texture.size_bytes(), 64u * 64 * 3 / 2);
}

TEST(EncodingOf, IsSrgbForColoursInCodesAlone)
{
    const renderer::TextureUse use;
    const auto image = codes(1, 1, 1, {0});
    EXPECT_EQ(renderer::encoding_of(use, *image, true), TextureEncoding::srgb);
    EXPECT_EQ(renderer::encoding_of(use, *image, false), TextureEncoding::linear);
    EXPECT_EQ(renderer::encoding_of(use, *light(1, 1, {0}), true), TextureEncoding::linear);
    renderer::TextureUse asked;
    asked.encoding = TextureEncoding::linear;
    EXPECT_EQ(renderer::encoding_of(asked, *image, true), TextureEncoding::linear);
}

} // namespace
