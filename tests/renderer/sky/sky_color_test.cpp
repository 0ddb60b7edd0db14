#include "renderer/sky/sky_color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

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

TEST(SkyColor, OfUnevenWavelengthsWeightsEachByWhatItStandsFor)
{
    // The blue is sampled five times as densely: it must not count five times.
    std::vector<double> even, uneven;
    for (int nm = 385; nm < 780; nm += 10)
        even.push_back(nm);
    for (int nm = 381; nm < 480; nm += 4)
        uneven.push_back(nm);
    for (int nm = 485; nm < 780; nm += 10)
        uneven.push_back(nm);
    std::reverse(uneven.begin(), uneven.end()); // in any order
    const auto color_of = [](const std::vector<double>& nm) {
        Spectrum spectrum{};
        for (std::size_t w = 0; w < nm.size(); ++w)
            spectrum[w] = (440 / nm[w]) * (440 / nm[w]) * (440 / nm[w]) * (440 / nm[w]);
        return SkyColor(nm, {1, 1, 1})(spectrum);
    };
    const Rgb a = color_of(even), b = color_of(uneven);
    EXPECT_NEAR(b.r / a.r, 1, 0.01);
    EXPECT_NEAR(b.g / a.g, 1, 0.01);
    EXPECT_NEAR(b.b / a.b, 1, 0.01);
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
