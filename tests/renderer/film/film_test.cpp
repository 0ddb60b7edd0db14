#include "renderer/film/film.h"

#include <gtest/gtest.h>

using renderer::Film;
using renderer::PixelRect;
using renderer::Rgb;
using renderer::TileSums;

TEST(Film, IsBlackBeforeTheFirstSample)
{
    const auto image = Film(PixelRect{3, 4, 2, 2}).mean();
    ASSERT_EQ(image.pixels.size(), 4u);
    for (const Rgb& pixel : image.pixels)
        EXPECT_EQ(pixel, Rgb{});
}

TEST(Film, PutsTilesWhereTheFullPictureHasThem)
{
    Film film(PixelRect{10, 20, 3, 2});
    film.merge(TileSums{{11, 21, 2, 1}, {{2, 4, 6}, {8, 10, 12}}});
    film.samples = 2;
    const auto image = film.mean();
    EXPECT_EQ(image.pixels[3], Rgb{});
    EXPECT_EQ(image.pixels[4], (Rgb{1, 2, 3}));
    EXPECT_EQ(image.pixels[5], (Rgb{4, 5, 6}));
}

TEST(Film, LosesNothingOfManySamples)
{
    // In float the sum would stop growing at 2^24.
    Film film(PixelRect{0, 0, 1, 1});
    for (int i = 0; i < (1 << 18); ++i)
        film.merge(TileSums{{0, 0, 1, 1}, {{0.1, 1000.1, 1e-3}}});
    film.samples = 1 << 18;
    const Rgb mean = film.mean().pixels.front();
    EXPECT_FLOAT_EQ(mean.r, 0.1f);
    EXPECT_FLOAT_EQ(mean.g, 1000.1f);
    EXPECT_FLOAT_EQ(mean.b, 1e-3f);
}
