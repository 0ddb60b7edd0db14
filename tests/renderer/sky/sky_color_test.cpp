#include "renderer/sky/sky_color.h"

#include <gtest/gtest.h>

using namespace renderer;

TEST(SkyColor, OfThreeWavelengthsTakesEachAsAChannel)
{
    const SkyColor color({440, 680, 550}, {1, 2, 3});
    Spectrum spectrum{};
    spectrum[0] = 0.5;
    spectrum[1] = 0.25;
    spectrum[2] = 1;
    EXPECT_EQ(color(spectrum), (Rgb{0.25f, 2, 1.5f}));
    EXPECT_EQ(color.share(spectrum), (Rgb{0.25f, 1, 0.5f}));
}

TEST(SkyColor, OfManyWavelengthsKeepsWhiteWhite)
{
    std::vector<double> nm;
    for (int i = 0; i < 16; ++i)
        nm.push_back(380 + 25 * i);
    const SkyColor color(nm, {1.5f, 1.5f, 1.5f});
    Spectrum white{}, blue{}, red{};
    white.fill(1);
    for (std::size_t w = 0; w < nm.size(); ++w)
        (nm[w] < 500 ? blue : red)[w] = nm[w] < 500 || nm[w] > 600 ? 1 : 0;
    EXPECT_NEAR(color(white).r, 1.5, 1e-5);
    EXPECT_NEAR(color(white).b, 1.5, 1e-5);
    EXPECT_GT(color(blue).b, 10 * color(blue).r);
    EXPECT_GT(color(red).r, 10 * color(red).b);
}
