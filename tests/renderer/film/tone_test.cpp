#include "renderer/film/tone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using renderer::filmic;

namespace {

// The formula of the source, before light is scaled.
double fitted(double x)
{
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

} // namespace

TEST(Tone, FilmicIsTheFittedCurve)
{
    constexpr double kScale = 0.7231708051;
    for (double x = 0.01; x < 10; x *= 1.1)
        EXPECT_NEAR(static_cast<double>(filmic(x)), fitted(kScale * x), 1e-7) << x;
}

TEST(Tone, FilmicKeepsMiddleGreyAndReachesWhite)
{
    EXPECT_NEAR(filmic(0.18), 0.18f, 1e-7f);
    EXPECT_LT(filmic(10.0), 1.0f);
    EXPECT_EQ(filmic(10.02), 1.0f);
    EXPECT_GT(filmic(1.0), 0.6f) << "white paper stays bright";
    EXPECT_LT(filmic(1.0), 0.8f) << "with room above it";
}

TEST(Tone, FilmicNeverFalls)
{
    float last = 0;
    for (double x = 1e-6; x < 1e6; x *= 1.01) {
        const float y = filmic(x);
        EXPECT_GE(y, last) << x;
        last = y;
    }
}

TEST(Tone, EndsAreEnds)
{
    const double inf = std::numeric_limits<double>::infinity();
    for (const auto tone : {renderer::Tone::srgb, renderer::Tone::linear, renderer::Tone::filmic}) {
        EXPECT_EQ(toned(0, tone), 0.0f);
        EXPECT_EQ(toned(-1, tone), 0.0f);
        EXPECT_EQ(toned(std::nan(""), tone), 0.0f);
        EXPECT_EQ(toned(inf, tone), 1.0f);
        EXPECT_EQ(toned(1e300, tone), 1.0f);
    }
}
