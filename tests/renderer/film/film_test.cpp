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

TEST(Film, FinishedIsItsMeanAndThatOfItsLayers)
{
    renderer::LayerSet layers;
    layers.add(renderer::Layer::depth);
    renderer::Film film(renderer::PixelRect{0, 0, 2, 1}, layers);
    film.samples = 2;
    film.sums[1] += renderer::Rgb{1, 2, 3};
    film.layers.add(1, 5, {0, 0, 1}, {});
    const auto image = film.mean();
    const auto means = film.layers.mean(2);
    const renderer::FinishedFilm finished = finish(std::move(film));
    EXPECT_EQ(finished.image.width_px, 2u);
    EXPECT_EQ(finished.image.pixels, image.pixels);
    ASSERT_EQ(finished.layers.size(), 1u);
    EXPECT_EQ(finished.layers[0].values, means[0].values);
    EXPECT_EQ(finished.layers[0].values[1], 5);
}
