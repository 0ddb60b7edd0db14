#include "server/jobs/kept_picture.h"
#include "server/store/store.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace {

using server::pack_picture;
using server::png_of;
using server::unpack_picture;

const std::vector<std::uint8_t> kPng{0x89, 'P', 'N', 'G', 1, 2, 3};

renderer::Picture some_picture()
{
    renderer::Picture picture;
    picture.image = {3, 2, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0, -1, 1e-40f}, {1e38f, 0, 0}, {}}};
    picture.exposure_ev = -1.5;
    picture.tone = renderer::Tone::filmic;
    picture.texts = {{"Software", "heliograph"}, {"heliograph", ""}};
    return picture;
}

std::vector<std::byte> bytes_of(const std::vector<std::uint8_t>& numbers)
{
    std::vector<std::byte> bytes(numbers.size());
    std::memcpy(bytes.data(), numbers.data(), numbers.size());
    return bytes;
}

TEST(KeptPicture, GivesBackThePngAndEveryBitOfTheFilm)
{
    const renderer::Picture picture = some_picture();
    const auto blob = pack_picture(picture, kPng);
    const auto png = png_of(blob);
    EXPECT_EQ(std::vector<std::byte>(png.begin(), png.end()), bytes_of(kPng));
    const auto back = unpack_picture(blob);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->image.width_px, 3u);
    EXPECT_EQ(back->image.height_px, 2u);
    EXPECT_TRUE(back->image.pixels == picture.image.pixels);
    EXPECT_EQ(back->exposure_ev, -1.5);
    EXPECT_EQ(back->tone, renderer::Tone::filmic);
    ASSERT_EQ(back->texts.size(), 2u);
    EXPECT_EQ(back->texts[0].keyword + back->texts[0].text, "Softwareheliograph");
    EXPECT_EQ(back->texts[1].keyword + back->texts[1].text, "heliograph");
}

TEST(KeptPicture, GivesBackEveryBitOfTheLayers)
{
    renderer::Picture picture = some_picture();
    const float far = std::numeric_limits<float>::infinity();
    picture.layers = {{renderer::Layer::depth, {1, 2, far, 4, 5, 1e-40f}},
                      {renderer::Layer::normal, std::vector<float>(18, -0.5f)},
                      {renderer::Layer::samples, std::vector<float>(6, 64)}};
    const auto blob = pack_picture(picture, kPng);
    const auto back = unpack_picture(blob);
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->image.pixels == picture.image.pixels);
    ASSERT_EQ(back->layers.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(back->layers[i].layer, picture.layers[i].layer);
        EXPECT_EQ(back->layers[i].values, picture.layers[i].values);
    }
    for (std::size_t size = 6; size < blob.size(); ++size)
        EXPECT_THROW(unpack_picture(std::span(blob).first(size)), server::StoreError) << size;
}

TEST(KeptPicture, OfABuildBeforeLayersHasNone)
{
    auto blob = pack_picture(some_picture(), kPng);
    ASSERT_EQ(blob[5], std::byte{2});
    blob[5] = std::byte{1};
    blob.pop_back(); // their number
    const auto back = unpack_picture(blob);
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->image.pixels == some_picture().image.pixels);
    EXPECT_TRUE(back->layers.empty());
}

TEST(KeptPicture, OfAnOlderBuildIsAPngAlone)
{
    const auto blob = bytes_of(kPng);
    EXPECT_EQ(png_of(blob).data(), blob.data());
    EXPECT_EQ(png_of(blob).size(), blob.size());
    EXPECT_FALSE(unpack_picture(blob));
}

TEST(KeptPicture, ThatIsCutOrLongerIsNotTaken)
{
    auto blob = pack_picture(some_picture(), kPng);
    for (std::size_t size = 6; size < blob.size(); ++size)
        EXPECT_THROW(unpack_picture(std::span(blob).first(size)), server::StoreError) << size;
    EXPECT_THROW(png_of(std::span(blob).first(10)), server::StoreError);
    blob.push_back(std::byte{0});
    EXPECT_THROW(unpack_picture(blob), server::StoreError);
}

} // namespace
