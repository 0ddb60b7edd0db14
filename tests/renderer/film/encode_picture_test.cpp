#include "renderer/film/encode_jpeg.h"
#include "renderer/film/encode_picture.h"
#include "renderer/film/encode_png.h"
#include "tests/support/decode_picture.h"

#include <gtest/gtest.h>

using renderer::entry_of;
using renderer::Picture;
using renderer::PictureFormat;

namespace {

Picture some_picture()
{
    Picture picture;
    picture.image = tests::some_radiance(20, 10);
    picture.exposure_ev = 2;
    picture.tone = renderer::Tone::filmic;
    picture.texts = {{"heliograph", "{}"}};
    return picture;
}

} // namespace

TEST(PictureFormats, StandAtTheirOwnPlace)
{
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats) {
        EXPECT_EQ(&entry_of(entry.format), &entry);
        EXPECT_EQ(renderer::find_picture_extension(entry.extension), &entry);
    }
    EXPECT_EQ(renderer::find_picture_extension(".jpeg"), &entry_of(PictureFormat::jpeg));
    EXPECT_EQ(renderer::find_picture_extension(""), nullptr);
    EXPECT_EQ(renderer::find_picture_extension(".gif"), nullptr);
}

TEST(EncodePicture, ShowsInPngAndJpegAndHoldsRadianceInTheOthers)
{
    const Picture picture = some_picture();
    const auto shown = develop_8(picture.image, 2, renderer::Tone::filmic);
    EXPECT_TRUE(encode_picture(picture, {PictureFormat::png, 8}) == encode_png(shown, picture.texts));
    EXPECT_TRUE(encode_picture(picture, {PictureFormat::jpeg, 8}) == encode_jpeg(shown, picture.texts));
    EXPECT_EQ(tests::decode_16(encode_picture(picture, {PictureFormat::png, 16})).values.size(), 600u);
    const auto exr = tests::decode_exr(encode_picture(picture, {PictureFormat::exr, 8}));
    EXPECT_EQ(exr.channels.at("R")[3], picture.image.pixels[3].r) << "not exposed";
    EXPECT_EQ(exr.texts.size(), 1u);
    EXPECT_EQ(tests::decode_hdr(encode_picture(picture, {PictureFormat::hdr, 8})).values.size(), 600u);
    const auto pfm = encode_picture(picture, {PictureFormat::pfm, 8});
    EXPECT_EQ(std::string(pfm.begin(), pfm.begin() + 2), "PF");
}
