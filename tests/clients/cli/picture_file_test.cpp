#include "clients/cli/picture_file.h"
#include "clients/cli/user_error.h"
#include "renderer/film/encode_exr.h"
#include "renderer/film/encode_jpeg.h"
#include "renderer/film/encode_pfm.h"
#include "renderer/film/encode_png.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using clients::read_pfm;
using clients::read_picture;
using clients::UserError;
using renderer::LinearImage;
using renderer::Rgb;

std::string text_of(const std::vector<std::uint8_t>& bytes)
{
    return {bytes.begin(), bytes.end()};
}

LinearImage gradient()
{
    LinearImage image{3, 2, {}};
    for (int i = 0; i < 6; ++i)
        image.pixels.push_back({0.1f * static_cast<float>(i), 1e-7f, 70000.0f});
    return image;
}

TEST(PictureFile, ReadsBackEveryBitOfAPfm)
{
    const LinearImage image = gradient();
    const LinearImage back = read_pfm(text_of(renderer::encode_pfm(image)), "test");
    EXPECT_EQ(back.width_px, 3u);
    EXPECT_EQ(back.height_px, 2u);
    EXPECT_TRUE(back.pixels == image.pixels);
}

TEST(PictureFile, ReadsBigEndianAndGreyPfm)
{
    const std::string one_and_two("\x3f\x80\x00\x00\x40\x00\x00\x00", 8);
    const LinearImage image = read_pfm("Pf\n1 2\n1.0\n" + one_and_two, "test");
    ASSERT_EQ(image.pixels.size(), 2u);
    EXPECT_TRUE(image.pixels[0] == (Rgb{2, 2, 2})) << "the file begins with the lowest row";
    EXPECT_TRUE(image.pixels[1] == (Rgb{1, 1, 1}));
}

TEST(PictureFile, RefusesPfmThatIsCutOrLies)
{
    const std::string good = text_of(renderer::encode_pfm(gradient()));
    EXPECT_THROW(read_pfm(good.substr(0, good.size() - 1), "test"), UserError);
    EXPECT_THROW(read_pfm(good + "x", "test"), UserError);
    EXPECT_THROW(read_pfm("PF\n4000000000 4000000000\n-1.0\n", "test"), UserError);
    EXPECT_THROW(read_pfm("PF\n0 1\n-1.0\n", "test"), UserError);
    EXPECT_THROW(read_pfm("PF\n1 1\nnan\n123456789012", "test"), UserError);
    EXPECT_THROW(read_pfm("PF\n1 1\n", "test"), UserError);
    EXPECT_THROW(read_pfm("PF", "test"), UserError);
}

// What develop() encodes comes back as the linear value at the middle of its step, within half a step.
TEST(PictureFile, DecodesPngAsSrgb)
{
    const tests::TempFolder folder;
    renderer::Image8 encoded{256, 1, {}, true};
    for (int i = 0; i < 256; ++i)
        for (int channel = 0; channel < 3; ++channel)
            encoded.rgb.push_back(static_cast<std::uint8_t>(i));
    const LinearImage image = read_picture(folder.write("steps.png", text_of(renderer::encode_png(encoded))));
    ASSERT_EQ(image.pixels.size(), 256u);
    EXPECT_EQ(image.pixels[0].r, 0.0f);
    EXPECT_EQ(image.pixels[255].g, 1.0f);
    EXPECT_NEAR(image.pixels[128].b, 0.2158605, 1e-6);
    const renderer::Image8 again = renderer::develop(image, renderer::ImageSettings{});
    EXPECT_EQ(again.rgb, encoded.rgb);
}

TEST(PictureFile, ReadsBackEveryBitOfAnExr)
{
    const tests::TempFolder folder;
    const LinearImage image = gradient();
    const std::string exr = text_of(encode_exr(3, 2, exr_channels(image)));
    const LinearImage back = read_picture(folder.write("a.exr", exr));
    EXPECT_EQ(back.width_px, 3u);
    EXPECT_EQ(back.height_px, 2u);
    EXPECT_TRUE(back.pixels == image.pixels);
    EXPECT_THROW(read_picture(folder.write("cut.exr", exr.substr(0, exr.size() / 2))), UserError);
    EXPECT_THROW(read_picture(folder.write("head.exr", exr.substr(0, 8))), UserError);
}

TEST(PictureFile, ReadsAnExrOfLuminanceAndRefusesOneWithoutColours)
{
    const tests::TempFolder folder;
    const std::vector<float> values{1, 2};
    const LinearImage grey =
        read_picture(folder.write("y.exr", text_of(renderer::encode_exr(2, 1, {{"Y", values.data()}}))));
    EXPECT_TRUE(grey.pixels == (std::vector<Rgb>{{1, 1, 1}, {2, 2, 2}}));
    EXPECT_THROW(read_picture(folder.write(
                     "z.exr", text_of(renderer::encode_exr(2, 1, {{"depth.Z", values.data()}})))),
                 UserError);
}

TEST(PictureFile, DecodesJpegAsSrgb)
{
    const tests::TempFolder folder;
    const renderer::Image8 grey{16, 16, std::vector<std::uint8_t>(16 * 16 * 3, 128), true};
    const LinearImage image = read_picture(folder.write("a.jpg", text_of(renderer::encode_jpeg(grey))));
    ASSERT_EQ(image.pixels.size(), 256u);
    EXPECT_NEAR(image.pixels[17].g, 0.2158605, 1e-6);
}

TEST(PictureFile, RefusesWhatIsNoPicture)
{
    const tests::TempFolder folder;
    EXPECT_THROW(read_picture(folder.write("empty.png", "")), UserError);
    EXPECT_THROW(read_picture(folder.write("text.png", "hello")), UserError);
    EXPECT_THROW(read_picture(folder.file("absent.png")), UserError);
    const std::string png = text_of(renderer::encode_png({2, 2, std::vector<std::uint8_t>(12, 7), true}));
    EXPECT_THROW(read_picture(folder.write("cut.png", png.substr(0, png.size() / 2))), UserError);
    EXPECT_THROW(
        read_picture(folder.write("lie.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 40000\n")),
        UserError);
}

} // namespace
