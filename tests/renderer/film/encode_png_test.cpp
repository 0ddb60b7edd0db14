#include "renderer/film/encode_png.h"
#include "tests/support/decode_picture.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

using renderer::Image16;
using renderer::Image8;

namespace {

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

TEST(Png, DecodesToTheSamePixels)
{
    Image8 image{7, 5, {}, true};
    for (int i = 0; i < 7 * 5 * 3; ++i)
        image.rgb.push_back(static_cast<std::uint8_t>(i * 37));
    const tests::Decoded decoded = tests::decode_8(encode_png(image));
    EXPECT_EQ(decoded.width_px, 7);
    EXPECT_EQ(decoded.height_px, 5);
    EXPECT_EQ(decoded.channels, 3);
    EXPECT_EQ(decoded.values, std::vector<float>(image.rgb.begin(), image.rgb.end()));
}

TEST(Png, HoldsSixteenBitsAChannel)
{
    Image16 image{7, 5, {}, true};
    for (int i = 0; i < 7 * 5 * 3; ++i)
        image.rgb.push_back(static_cast<std::uint16_t>(i * 617 + 1));
    const auto png = encode_png(image);
    const tests::Decoded decoded = tests::decode_16(png);
    EXPECT_EQ(decoded.width_px, 7);
    EXPECT_EQ(decoded.height_px, 5);
    EXPECT_EQ(decoded.values, std::vector<float>(image.rgb.begin(), image.rgb.end()));
    EXPECT_EQ(chunk_types(png), "IHDR sRGB IDAT IEND ");
}

TEST(Png, CarriesTheColourSpaceAndItsTexts)
{
    Image8 image{1, 1, {1, 2, 3}, true};
    const auto png = encode_png(image, {{"heliograph", "seed=1"}});
    EXPECT_EQ(chunk_types(png), "IHDR sRGB iTXt IDAT IEND ");
    const std::string bytes(png.begin(), png.end());
    // The CRC of an sRGB chunk with intent 0, as every PNG has it.
    EXPECT_NE(bytes.find(std::string("sRGB\0\xae\xce\x1c\xe9", 9)), std::string::npos);
    EXPECT_NE(bytes.find(std::string("heliograph\0\0\0\0\0seed=1", 21)), std::string::npos);
    image.srgb = false;
    EXPECT_EQ(chunk_types(encode_png(image)), "IHDR gAMA IDAT IEND ");
}

TEST(Png, HasTheSameBytesForTheSamePixels)
{
    const Image8 image{2, 2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, true};
    EXPECT_EQ(encode_png(image), encode_png(image));
}

TEST(Png, RefusesAPictureWithoutPixels)
{
    EXPECT_THROW(encode_png(Image8{}), std::runtime_error);
    EXPECT_THROW(encode_png(Image16{}), std::runtime_error);
}
