#include "clients/cli/picture_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using clients::difference;
using clients::PictureDifference;
using renderer::LinearImage;
using renderer::Rgb;

LinearImage flat(std::uint32_t width, std::uint32_t height, Rgb color)
{
    return {width, height, std::vector<Rgb>(std::size_t{width} * height, color)};
}

// Errors of a constant offset have a closed form.
TEST(PictureDifference, IsTheOffsetOfFlatPictures)
{
    const auto found = difference(flat(4, 3, {0.75f, 0.5f, 0.25f}), flat(4, 3, {0.5f, 0.5f, 0.5f}));
    ASSERT_TRUE(found);
    EXPECT_DOUBLE_EQ(found->rmse, std::sqrt((0.0625 + 0 + 0.0625) / 3));
    // ref^2 + (0.2 m)^2 with ref = m = 0.5: 0.25 * 1.04.
    EXPECT_DOUBLE_EQ(found->relative_rmse, std::sqrt((0.0625 + 0.0625) / (0.25 * 1.04) / 3));
    EXPECT_DOUBLE_EQ(found->max, 0.25);
    EXPECT_DOUBLE_EQ(found->mean[0], 0.25);
    EXPECT_DOUBLE_EQ(found->mean[1], 0);
    EXPECT_DOUBLE_EQ(found->mean[2], -0.25);
    EXPECT_EQ(found->non_finite_pixels, 0u);
}

// Half the reference black: there the denominator is e alone.
TEST(PictureDifference, WeighsBlackPixelsByTheMeanOfTheReference)
{
    LinearImage reference = flat(2, 1, {1, 1, 1});
    reference.pixels[1] = {0, 0, 0}; // m = 0.5, e = 0.01
    LinearImage picture = reference;
    picture.pixels[1] = {0.1f, 0.1f, 0.1f};
    const double d = static_cast<double>(0.1f);
    const auto found = difference(picture, reference);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->relative_rmse, std::sqrt(d * d / 0.01 / 2), 1e-12);
}

TEST(PictureDifference, DoesNotChangeWhenBothAreDimmed)
{
    LinearImage reference = flat(3, 1, {0.2f, 0.4f, 0.6f}), picture = flat(3, 1, {0.3f, 0.4f, 0.5f});
    const double before = difference(picture, reference)->relative_rmse;
    for (LinearImage* image : {&reference, &picture})
        for (Rgb& pixel : image->pixels)
            pixel = pixel * 0.015625f; // a power of two: exact
    EXPECT_DOUBLE_EQ(difference(picture, reference)->relative_rmse, before);
}

TEST(PictureDifference, OfAPictureWithItselfIsZero)
{
    const LinearImage image = flat(5, 5, {3.0f, 1e-20f, 1e20f});
    const auto found = difference(image, image);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->rmse, 0);
    EXPECT_EQ(found->relative_rmse, 0);
    EXPECT_EQ(found->max, 0);
}

TEST(PictureDifference, WithAnAllBlackReferenceIsZeroOrInfinite)
{
    const LinearImage black = flat(2, 2, {});
    EXPECT_EQ(difference(black, black)->relative_rmse, 0);
    LinearImage lit = black;
    lit.pixels[3].g = 0.5f;
    EXPECT_EQ(difference(lit, black)->relative_rmse, std::numeric_limits<double>::infinity());
    EXPECT_NE(write_json(*difference(lit, black)).find("\"relative_rmse\":null"), std::string::npos);
}

TEST(PictureDifference, NeedsEqualSizes)
{
    EXPECT_FALSE(difference(flat(2, 3, {}), flat(3, 2, {})));
}

TEST(PictureDifference, LeavesOutAndCountsPixelsThatAreNotFinite)
{
    LinearImage reference = flat(4, 1, {1, 1, 1}), picture = flat(4, 1, {1.5f, 1, 1});
    picture.pixels[0].b = std::numeric_limits<float>::quiet_NaN();
    reference.pixels[2].r = std::numeric_limits<float>::infinity();
    const auto found = difference(picture, reference);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->non_finite_pixels, 2u);
    EXPECT_DOUBLE_EQ(found->rmse, std::sqrt(0.25 / 3));
    EXPECT_DOUBLE_EQ(found->mean[0], 0.5);
}

TEST(PictureDifference, IsWrittenAsJson)
{
    PictureDifference d;
    d.rmse = 0.5;
    d.relative_rmse = 0.25;
    d.max = 1;
    d.mean = {0.125, 0, -0.125};
    d.non_finite_pixels = 3;
    EXPECT_EQ(write_json(d),
              "{\"rmse\":0.5,\"relative_rmse\":0.25,\"max\":1,\"mean\":[0.125,0,-0.125],\"non_finite_"
              "pixels\":3}\n");
}

} // namespace
