#include "renderer/lights/light_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using renderer::illuminate;
using renderer::LightSample;
using renderer::prepare_light;
using renderer::Rgb;
using renderer::Vec3d;

namespace {

renderer::SpotLight spot_down(double inner, double outer)
{
    renderer::SpotLight spot;
    spot.position = {0, 1, 0};
    spot.direction = {0, -3, 0};
    spot.inner_deg = inner;
    spot.outer_deg = outer;
    return spot;
}

// Irradiance at distance 1 from the spot, `degrees` off its axis.
float spot_at(const renderer::SpotLight& spot, double degrees)
{
    const double a = degrees * 3.14159265358979323846 / 180;
    return illuminate(prepare_light(spot), Vec3d{std::sin(a), 1 - std::cos(a), 0}).irradiance.r;
}

} // namespace

TEST(PointLight, FallsOffWithTheSquareOfTheDistance)
{
    const auto light = prepare_light(renderer::PointLight{{1, 2, 3}, {8, 4, 2}});
    const LightSample s = illuminate(light, {1, 2, 1});
    EXPECT_EQ(s.irradiance, (Rgb{2, 1, 0.5f}));
    EXPECT_EQ(s.distance, 2);
    EXPECT_EQ(s.wi, (Vec3d{0, 0, 1}));
}

TEST(PointLight, GivesNothingInItsOwnPlace)
{
    EXPECT_EQ(illuminate(prepare_light(renderer::PointLight{{1, 2, 3}, {1, 1, 1}}), {1, 2, 3}).irradiance,
              Rgb{});
}

TEST(PointLight, KeepsItsScaleFromTinyToHuge)
{
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const auto intensity = static_cast<float>(scale * scale);
        const auto light =
            prepare_light(renderer::PointLight{{0, 3 * scale, 0}, {intensity, intensity, intensity}});
        EXPECT_NEAR(illuminate(light, {0, scale, 0}).irradiance.r, 0.25, 1e-6) << scale;
    }
}

TEST(SpotLight, IsFullInsideNothingOutsideAndSmoothBetween)
{
    const auto spot = spot_down(20, 30);
    EXPECT_EQ(spot_at(spot, 0), 1);
    EXPECT_NEAR(spot_at(spot, 19.99), 1, 1e-6);
    EXPECT_EQ(spot_at(spot, 30.01), 0);
    EXPECT_EQ(spot_at(spot, 180), 0);
    float before = 1;
    for (double degrees = 20; degrees <= 30; degrees += 0.25) {
        const float now = spot_at(spot, degrees);
        EXPECT_LE(now, before + 1e-6f);
        EXPECT_GE(now, before - 0.06f);
        before = now;
    }
}

TEST(SpotLight, HasASharpEdgeWhereItsConesAreEqual)
{
    const auto spot = spot_down(25, 25);
    EXPECT_NEAR(spot_at(spot, 24.999), 1, 1e-6);
    EXPECT_EQ(spot_at(spot, 25.001), 0);
}

TEST(DirectionalLight, IsTheSameEverywhereAndHasNoEnd)
{
    const auto light = prepare_light(renderer::DirectionalLight{{0, -5, 0}, {3, 2, 1}});
    for (const Vec3d p : {Vec3d{0, 0, 0}, Vec3d{1e9, -1e9, 4}}) {
        const LightSample s = illuminate(light, p);
        EXPECT_EQ(s.wi, (Vec3d{0, 1, 0}));
        EXPECT_EQ(s.distance, std::numeric_limits<double>::infinity());
        EXPECT_EQ(s.irradiance, (Rgb{3, 2, 1}));
    }
}
