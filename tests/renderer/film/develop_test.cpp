#include "renderer/film/develop.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>

using renderer::Image8;
using renderer::ImageSettings;
using renderer::LinearImage;

namespace {

LinearImage one_pixel(float r, float g, float b)
{
    return {1, 1, {{r, g, b}}};
}

std::string chunk_types(const std::vector<std::uint8_t>& png)
{
    std::string types;
    for (std::size_t at = 8; at + 8 <= png.size();) {
        const std::size_t length = (std::size_t{png[at]} << 24) | (std::size_t{png[at + 1]} << 16) |
                                   (std::size_t{png[at + 2]} << 8) | png[at + 3];
        types += std::string(png.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                             png.begin() + static_cast<std::ptrdiff_t>(at) + 8) +
                 " ";
        at += 12 + length;
    }
    return types;
}

} // namespace

TEST(Develop, AppliesExposureThenTone)
{
    ImageSettings settings;
    EXPECT_EQ(develop(one_pixel(0.5f, 1, 2), settings).rgb, (std::vector<std::uint8_t>{188, 255, 255}));
    settings.exposure_ev = -1;
    EXPECT_EQ(develop(one_pixel(1, 2, 0), settings).rgb, (std::vector<std::uint8_t>{188, 255, 0}));
    settings.tone = renderer::Tone::linear;
    EXPECT_EQ(develop(one_pixel(1, 0.5f, 4), settings).rgb, (std::vector<std::uint8_t>{128, 64, 255}));
}

TEST(Develop, SurvivesValuesThatAreNoColours)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    ImageSettings settings;
    settings.exposure_ev = 1e300;
    EXPECT_EQ(develop(one_pixel(nan, inf, -1), settings).rgb, (std::vector<std::uint8_t>{0, 0, 0}));
}

TEST(Png, DecodesToTheSamePixels)
{
    Image8 image{7, 5, {}, true};
    for (int i = 0; i < 7 * 5 * 3; ++i)
        image.rgb.push_back(static_cast<std::uint8_t>(i * 37));
    const auto png = encode_png(image);
    int width = 0, height = 0, channels = 0;
    stbi_uc* const pixels =
        stbi_load_from_memory(png.data(), static_cast<int>(png.size()), &width, &height, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    EXPECT_EQ(width, 7);
    EXPECT_EQ(height, 5);
    EXPECT_EQ(channels, 3);
    EXPECT_EQ(std::memcmp(pixels, image.rgb.data(), image.rgb.size()), 0);
    stbi_image_free(pixels);
}

TEST(Png, CarriesTheColourSpaceAndItsTexts)
{
    Image8 image{1, 1, {1, 2, 3}, true};
    const renderer::PngText text{"heliograph", "seed=1"};
    const auto png = encode_png(image, std::span(&text, 1));
    EXPECT_EQ(chunk_types(png), "IHDR sRGB iTXt IDAT IEND ");
    const std::string bytes(png.begin(), png.end());
    // The CRC of an sRGB chunk with intent 0, as every PNG has it.
    EXPECT_NE(bytes.find(std::string("sRGB\0\xae\xce\x1c\xe9", 9)), std::string::npos);
    EXPECT_NE(bytes.find(std::string("heliograph\0\0\0\0\0seed=1", 21)), std::string::npos);
    image.srgb = false;
    EXPECT_EQ(chunk_types(encode_png(image)), "IHDR IDAT IEND ");
}

TEST(Png, HasTheSameBytesForTheSamePixels)
{
    const Image8 image{2, 2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, true};
    EXPECT_EQ(encode_png(image), encode_png(image));
}

TEST(Png, RefusesAPictureWithoutPixels)
{
    EXPECT_THROW(encode_png(Image8{}), std::runtime_error);
}

TEST(Pfm, StoresRowsFromTheBottom)
{
    const LinearImage image{1, 2, {{1, 2, 3}, {4, 5, 6}}};
    const auto bytes = encode_pfm(image);
    const std::string header = "PF\n1 2\n-1.0\n";
    ASSERT_EQ(bytes.size(), header.size() + 24);
    EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.size())), header);
    // 4.0f little-endian first: the lower row.
    const std::vector<std::uint8_t> four{0, 0, 0x80, 0x40};
    EXPECT_EQ(std::vector<std::uint8_t>(bytes.begin() + static_cast<std::ptrdiff_t>(header.size()),
                                        bytes.begin() + static_cast<std::ptrdiff_t>(header.size()) + 4),
              four);
}
