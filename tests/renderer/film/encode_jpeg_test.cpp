#include "renderer/film/encode_jpeg.h"
#include "tests/support/decode_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

using renderer::Image8;

namespace {

Image8 gradients(std::uint32_t width_px, std::uint32_t height_px)
{
    Image8 image{width_px, height_px, {}, true};
    for (std::uint32_t y = 0; y < height_px; ++y)
        for (std::uint32_t x = 0; x < width_px; ++x)
            for (const std::uint32_t code : {x * 255 / width_px, y * 255 / height_px, (x + y) % 256})
                image.rgb.push_back(static_cast<std::uint8_t>(code));
    return image;
}

} // namespace

TEST(Jpeg, DecodesToNearlyTheSamePixels)
{
    const Image8 image = gradients(61, 43);
    const tests::Decoded decoded = tests::decode_8(encode_jpeg(image));
    ASSERT_EQ(decoded.values.size(), image.rgb.size());
    EXPECT_EQ(decoded.width_px, 61);
    EXPECT_EQ(decoded.height_px, 43);
    double squares = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        squares += std::pow(static_cast<double>(decoded.values[i]) - image.rgb[i], 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(image.rgb.size())), 3.0);
}

// Half the resolution of colour would smear these lines into one another.
TEST(Jpeg, KeepsColourAtFullResolution)
{
    Image8 lines{32, 32, {}, true};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            lines.rgb.insert(lines.rgb.end(),
                             {static_cast<std::uint8_t>(x % 2 ? 220 : 40),
                              90,
                              static_cast<std::uint8_t>(x % 2 ? 40 : 220)});
    const tests::Decoded decoded = tests::decode_8(encode_jpeg(lines));
    ASSERT_EQ(decoded.values.size(), lines.rgb.size());
    for (std::size_t i = 0; i < lines.rgb.size(); ++i)
        EXPECT_NEAR(decoded.values[i], lines.rgb[i], 20) << i;
}

TEST(Jpeg, CarriesItsTextsAsComments)
{
    const auto jpeg =
        encode_jpeg(gradients(8, 8), {{"Software", "heliograph"}, {"heliograph", "{\"seed\":1}"}});
    const std::string bytes(jpeg.begin(), jpeg.end());
    const auto comment = [](const std::string& text) {
        const auto length = static_cast<char>(text.size() + 2);
        return std::string("\xff\xfe\0", 3) + length + text;
    };
    EXPECT_NE(bytes.find(comment("Software: heliograph")), std::string::npos);
    EXPECT_NE(bytes.find(comment("heliograph: {\"seed\":1}")), std::string::npos);
    const auto plain = encode_jpeg(gradients(8, 8));
    EXPECT_EQ(std::string(plain.begin(), plain.end()).find("\xff\xfe"), std::string::npos);
    EXPECT_TRUE(plain == encode_jpeg(gradients(8, 8)));
}

TEST(Jpeg, IsLargerThanOneBuffer)
{
    Image8 noise{400, 400, {}, true};
    std::uint32_t state = 1;
    for (int i = 0; i < 400 * 400 * 3; ++i)
        noise.rgb.push_back(static_cast<std::uint8_t>((state = state * 1664525 + 1013904223) >> 24));
    const auto jpeg = encode_jpeg(noise);
    EXPECT_GT(jpeg.size(), std::size_t{1} << 17);
    EXPECT_EQ(tests::decode_8(jpeg).values.size(), noise.rgb.size());
}

TEST(Jpeg, RefusesWhatTheFormatCannotHold)
{
    EXPECT_THROW(encode_jpeg(Image8{}), std::runtime_error);
    EXPECT_THROW(encode_jpeg(Image8{65536, 1, std::vector<std::uint8_t>(65536 * 3), true}),
                 std::runtime_error);
    EXPECT_NO_THROW(encode_jpeg(Image8{65500, 1, std::vector<std::uint8_t>(65500 * 3), true}));
}
