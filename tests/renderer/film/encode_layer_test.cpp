#include "renderer/color/srgb.h"
#include "renderer/film/encode_layer.h"
#include "renderer/film/encode_picture.h"
#include "tests/support/decode_picture.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

using namespace renderer;

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

// Two pixels with every layer.
Picture some_picture()
{
    Picture picture;
    picture.image = {2, 1, {{1, 2, 3}, {4, 5, 6}}};
    picture.exposure_ev = 5; // of no concern to a layer
    picture.texts = {{"Software", "heliograph"}};
    picture.layers = {{Layer::depth, {1.5f, kFar}},
                      {Layer::normal, {0, 0.6f, 0.8f, -1, 0, 0}},
                      {Layer::albedo, {0.25f, 0.5f, 1, 0, 2, 0.125f}},
                      {Layer::samples, {16, 16}}};
    return picture;
}

std::vector<std::uint8_t> encoded(std::size_t layer, PictureFormat format, std::uint8_t bits = 8)
{
    const Picture picture = some_picture();
    return encode_layer(picture, picture.layers[layer], {format, bits});
}

} // namespace

TEST(EncodeLayer, KeepsEveryBitInExr)
{
    const Picture picture = some_picture();
    for (const LayerImage& layer : picture.layers) {
        const LayerEntry& entry = entry_of(layer.layer);
        const tests::DecodedExr decoded =
            tests::decode_exr(encode_layer(picture, layer, {PictureFormat::exr, 8}));
        ASSERT_EQ(decoded.error, "");
        ASSERT_EQ(decoded.channels.size(), entry.channel_count());
        for (std::size_t c = 0; c < entry.channel_count(); ++c)
            for (std::size_t i = 0; i < 2; ++i)
                EXPECT_EQ(decoded.channels.at(std::string(entry.channels[c]))[i],
                          layer.values[i * entry.channel_count() + c]);
        EXPECT_EQ(decoded.texts.at("software"), "heliograph");
    }
}

TEST(EncodeLayer, WritesPfmOfOneChannelOrThree)
{
    const auto depth = encoded(0, PictureFormat::pfm), normal = encoded(1, PictureFormat::pfm);
    EXPECT_EQ(std::string(depth.begin(), depth.begin() + 12), "Pf\n2 1\n-1.0\n");
    EXPECT_EQ(depth.size(), 12u + 2 * 4);
    EXPECT_EQ(std::string(normal.begin(), normal.begin() + 12), "PF\n2 1\n-1.0\n");
    EXPECT_EQ(normal.size(), 12u + 6 * 4);
}

TEST(EncodeLayer, CodesNormalsByHalvesAndAlbedosAsSrgb)
{
    EXPECT_EQ(tests::decode_8(encoded(1, PictureFormat::png)).values,
              (std::vector<float>{128, 204, 230, 0, 128, 128}));
    EXPECT_EQ(tests::decode_16(encoded(1, PictureFormat::png, 16)).values,
              (std::vector<float>{32768, 52428, 58982, 0, 32768, 32768}));
    const auto code = [](float x) { return static_cast<float>(srgb_8_from_linear(x)); };
    EXPECT_EQ(tests::decode_8(encoded(2, PictureFormat::png)).values,
              (std::vector<float>{code(0.25f), code(0.5f), 255, 0, 255, code(0.125f)}));
}

TEST(EncodePicture, CarriesTheLayersInExr)
{
    const tests::DecodedExr decoded =
        tests::decode_exr(encode_picture(some_picture(), {PictureFormat::exr, 8}));
    ASSERT_EQ(decoded.error, "");
    EXPECT_EQ(decoded.channels.size(), 3u + 1 + 3 + 3 + 1);
    EXPECT_EQ(decoded.channels.at("G"), (std::vector<float>{2, 5}));
    EXPECT_EQ(decoded.channels.at("Z"), (std::vector<float>{1.5f, kFar}));
    EXPECT_EQ(decoded.channels.at("N.Z"), (std::vector<float>{0.8f, 0}));
    EXPECT_EQ(decoded.channels.at("albedo.G"), (std::vector<float>{0.5f, 2}));
    EXPECT_EQ(decoded.channels.at("samples"), (std::vector<float>{16, 16}));
}
