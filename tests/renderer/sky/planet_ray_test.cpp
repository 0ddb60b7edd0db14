#include "renderer/math/transcendental.h"
#include "renderer/sky/planet_ray.h"

#include <gtest/gtest.h>

#include <cmath>

using renderer::PlanetRay;

namespace {
constexpr double kEarth = 6'360'000;
}

TEST(PlanetRay, KeepsMetresAtPlanetScale)
{
    const auto [sine, mu] = renderer::sin_cos_deg(60);
    const PlanetRay ray(kEarth, 2, mu);
    EXPECT_NEAR(ray.altitude(ray.start()), 2, 1e-8);
    EXPECT_NEAR(ray.distance_at(2), ray.start(), 1e-6);
    EXPECT_NEAR(ray.altitude(ray.start() + 10), 7.0000059, 1e-6); // 2 + 10 cos 60, and (10 sin 60)^2 / 2R
    EXPECT_NEAR(sine, ray.radius_at(0) / (kEarth + 2), 1e-15);
}

TEST(PlanetRay, GrazesTheGroundWithinABillionthOfARadianOfTheDip)
{
    for (const double altitude : {1e-3, 1.7, 1000.0, 400'000.0}) {
        const double dip_cosine = -std::sqrt(altitude * (2 * kEarth + altitude)) / (kEarth + altitude);
        EXPECT_TRUE(PlanetRay(kEarth, altitude, dip_cosine - 1e-9).hits_ground()) << altitude;
        const PlanetRay above(kEarth, altitude, dip_cosine + 1e-9);
        EXPECT_FALSE(above.hits_ground()) << altitude;
        EXPECT_LT(above.perigee(), 1e-9 * kEarth);
    }
}

TEST(PlanetRay, LooksAlongTheHorizonFromTheGround)
{
    const PlanetRay level(kEarth, 0, 0);
    EXPECT_FALSE(level.hits_ground());
    const PlanetRay::Reach reach = level.reach(60'000);
    EXPECT_EQ(reach.begin, 0);
    EXPECT_NEAR(reach.end, std::sqrt(60'000.0 * (2 * kEarth + 60'000)), 1e-6);
    const PlanetRay down(kEarth, 0, -1);
    EXPECT_TRUE(down.hits_ground());
    EXPECT_EQ(down.ground(), down.start());
}

TEST(PlanetRay, FromSpaceEntersTheAirOrMissesIt)
{
    const PlanetRay limb = PlanetRay::through(kEarth, 1e7, 20'000, true);
    EXPECT_FALSE(limb.hits_ground());
    const PlanetRay::Reach reach = limb.reach(60'000);
    EXPECT_DOUBLE_EQ(reach.begin, -reach.end);
    EXPECT_NEAR(limb.altitude(reach.begin), 60'000, 1e-7);
    const PlanetRay past = PlanetRay::through(kEarth, 1e7, 60'001, true);
    EXPECT_EQ(past.reach(60'000).end, past.reach(60'000).begin);
}

TEST(PlanetRay, SeesTheSameSightFromHalfWayAlong)
{
    const auto [sine, mu] = renderer::sin_cos_deg(95);
    const PlanetRay ray(kEarth, 50'000, mu);
    const double u = ray.start() + 300'000;
    const PlanetRay later(kEarth, ray.altitude(u), ray.mu(u));
    EXPECT_NEAR(later.perigee(), ray.perigee(), 1e-7);
    EXPECT_NEAR(later.start(), u, 1e-6);
    EXPECT_GT(sine, 0);
}
