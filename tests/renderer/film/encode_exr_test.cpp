#include "renderer/film/encode_exr.h"
#include "tests/support/decode_picture.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

using renderer::ExrChannel;
using renderer::LinearImage;

TEST(Exr, DecodesToTheSameBits)
{
    for (const std::uint32_t height : {1u, 16u, 17u, 50u}) {
        const LinearImage image = tests::some_radiance(37, height);
        const auto exr = encode_exr(37, height, exr_channels(image));
        const tests::DecodedExr decoded = tests::decode_exr(exr);
        ASSERT_EQ(decoded.error, "");
        ASSERT_EQ(decoded.height_px, static_cast<int>(height));
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            ASSERT_EQ(decoded.channels.at("R")[i], image.pixels[i].r);
            ASSERT_EQ(decoded.channels.at("G")[i], image.pixels[i].g);
            ASSERT_EQ(decoded.channels.at("B")[i], image.pixels[i].b);
        }
    }
}

TEST(Exr, KeepsABlockThatDoesNotGetSmallerAsItIs)
{
    std::vector<float> noise;
    std::uint32_t state = 1;
    for (int i = 0; i < 5; ++i)
        noise.push_back(static_cast<float>((state = state * 1664525 + 1013904223) >> 8));
    const auto exr = renderer::encode_exr(5, 1, {{"Y", noise.data()}});
    EXPECT_EQ(tests::decode_exr(exr).channels.at("Y"), noise);
}

TEST(Exr, HoldsManyChannelsInTheOrderOfTheirNames)
{
    const std::vector<float> near_and_far{1.5f, std::numeric_limits<float>::infinity()};
    const LinearImage image{2, 1, {{1, 2, 3}, {4, 5, 6}}};
    std::vector<ExrChannel> channels = exr_channels(image);
    channels.push_back({"depth.Z", near_and_far.data()});
    channels.push_back({"a_name_of_more_than_thirty_one_bytes", near_and_far.data()});
    const tests::DecodedExr decoded = tests::decode_exr(renderer::encode_exr(2, 1, channels));
    ASSERT_EQ(decoded.error, "");
    EXPECT_EQ(decoded.channels.size(), 5u);
    EXPECT_EQ(decoded.channels.at("depth.Z"), near_and_far);
    EXPECT_EQ(decoded.channels.at("G"), (std::vector<float>{2, 5}));
}

TEST(Exr, CarriesItsTextsAsAttributes)
{
    const LinearImage image{1, 1, {{1, 2, 3}}};
    const auto exr =
        encode_exr(1, 1, exr_channels(image), {{"Software", "heliograph"}, {"heliograph", "{\"seed\":1}"}});
    const tests::DecodedExr decoded = tests::decode_exr(exr);
    EXPECT_EQ(decoded.texts.at("software"), "heliograph");
    EXPECT_EQ(decoded.texts.at("heliograph"), "{\"seed\":1}");
    EXPECT_TRUE(tests::decode_exr(encode_exr(1, 1, exr_channels(image))).texts.empty());
}
