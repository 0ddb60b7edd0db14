#include "renderer/math/affine.h"
#include "renderer/math/transcendental.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/sky.h"
#include "tests/support/random_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace renderer;

namespace {

AtmosphereDescription fast(AtmospherePreset preset)
{
    AtmosphereDescription d = atmosphere_preset(preset);
    d.mode = SkyMode::fast;
    return d;
}

// What leaves upwards at an altitude.
double exitance(const Sky& sky, double altitude, double sun_zenith, std::size_t w)
{
    const GaussLegendre rule(40);
    const double horizon =
        std::sqrt(altitude * (2 * sky.air().radius_m + altitude)) / (sky.air().radius_m + altitude);
    double sum = 0;
    for (const bool limb : {false, true})
        for (std::size_t i = 0; i < rule.x.size(); ++i) {
            const double low = limb ? 0 : horizon, high = limb ? horizon : 1;
            const double down = low + (high - low) * rule.x[i];
            const double view = 180 - std::acos(down) * 180 / kPi;
            for (int a = 0; a <= 16; ++a) {
                const SkyRadiance found =
                    sky.radiance(SkyGeometry::from_angles_deg(altitude, sun_zenith, view, a * 180.0 / 16));
                sum += (found.single[w] + found.multiple[w]) * down * (high - low) * rule.weight[i] *
                       (a == 0 || a == 16 ? 1 : 2) * kPi / 16;
            }
        }
    return sum;
}

} // namespace

// Air that absorbs nothing over black ground: what comes in goes to the ground or out again. What leaves at the top has
// spread from where it was scattered, a scale height up, to a larger sphere.
TEST(ScatteredLight, LosesAndGainsNoLight)
{
    ThreadPool pool;
    const Sky sky(fast(AtmospherePreset::reference_r), pool);
    for (const double sun_zenith : {30.0, 60.0}) {
        const double mu_sun = sin_cos_deg(sun_zenith).second;
        const SkyIrradiance ground = sky.irradiance(0, mu_sun);
        for (std::size_t w = 0; w < 3; ++w) {
            const double spread = 6'420'000.0 / 6'368'000.0;
            const double out = exitance(sky, 60'000, sun_zenith, w) * spread * spread;
            EXPECT_NEAR((ground.sun[w] + ground.single[w] + ground.multiple[w] + out) / mu_sun, 1, 0.01)
                << sun_zenith << ' ' << w;
        }
    }
}

TEST(ScatteredLight, HasTheSameBitsHoweverManyThreads)
{
    ThreadPool one(1), three(3);
    const Sky a(fast(AtmospherePreset::reference_r), one), b(fast(AtmospherePreset::reference_r), three);
    for (const double sun : {0.0, 60.0, 91.0, 97.0})
        for (const double view : {0.0, 60.0, 89.0, 120.0}) {
            const SkyGeometry geometry = SkyGeometry::from_angles_deg(500, sun, view, 30);
            EXPECT_EQ(a.radiance(geometry).multiple, b.radiance(geometry).multiple);
        }
}

TEST(ScatteredLight, FadesThroughNight)
{
    ThreadPool pool;
    const Sky sky(fast(AtmospherePreset::earth), pool);
    double before = 1;
    for (const double below : {-5.0, 1.0, 6.0, 12.0, 18.0}) {
        const SkyRadiance found = sky.radiance(SkyGeometry::from_angles_deg(0, 90 + below, 20, 0));
        const double now = found.single[1] + found.multiple[1];
        EXPECT_GE(now, 0);
        EXPECT_LT(now, before) << below;
        before = now;
    }
    EXPECT_LT(before, 1e-6);
    EXPECT_EQ(sky.radiance(SkyGeometry::from_angles_deg(0, 180, 0, 0)).multiple[1], 0);
}

TEST(ScatteredLight, IsContinuousFromTheGroundToTenRadii)
{
    ThreadPool pool;
    const Sky sky(fast(AtmospherePreset::reference_b), pool);
    const auto blue = [&](double altitude, double sun, double view) {
        const SkyRadiance found = sky.radiance(SkyGeometry::from_angles_deg(altitude, sun, view, 30));
        return found.single[2] + found.multiple[2];
    };
    for (const double sun : {10.0, 88.0, 96.0})
        for (const double view : {20.0, 70.0, 100.0, 180.0}) {
            for (int frame = 0; frame < 200; ++frame) {
                const double altitude = 1.7 * std::pow(10 * 6.36e6 / 1.7, frame / 199.0),
                             step = altitude * 1e-4;
                const double here = blue(altitude, sun, view), below = blue(altitude - step, sun, view),
                             above = blue(altitude + step, sun, view);
                EXPECT_LE(std::abs(below - 2 * here + above), 1e-3 * std::max({here, below, above}))
                    << altitude << ' ' << view;
            }
        }
}

TEST(ScatteredLight, DoesNotStepWhereTheAirEnds)
{
    ThreadPool pool;
    const Sky sky(fast(AtmospherePreset::reference_b), pool);
    const double radius = sky.air().radius_m;
    for (const double sun : {10.0, 88.0, 96.0})
        for (const double tangent : {-1.0, 0.0, 10'000.0, 36'000.0, 50'000.0}) {
            const auto at = [&](double altitude) {
                const SkyRadiance found =
                    sky.radiance(tangent < 0 ? PlanetRay(radius, altitude, -1)
                                             : PlanetRay::through(radius, altitude, tangent, true),
                                 SkyGeometry::towards_tangent_deg(radius, altitude, tangent, sun, 0));
                return found.single[2] + found.multiple[2];
            };
            // With the sun's angle kept, where the ray passes the ground moves under it: by dusk 2 m are 2e-4 of the light.
            const double below = at(59'997), within = at(59'999), beyond = at(60'001);
            EXPECT_LE(std::abs(beyond - 2 * within + below), 1e-4 * within) << sun << ' ' << tangent;
        }
}

TEST(ScatteredLight, IsTheSameHoweverTheWorldIsTurned)
{
    ThreadPool pool;
    const Sky sky(fast(AtmospherePreset::reference_b), pool);
    const auto seen = [&](Vec3d up, Vec3d view, Vec3d sun) {
        const SkyRadiance found = sky.radiance({500, dot(up, view), dot(up, sun), dot(view, sun)});
        return found.single[2] + found.multiple[2];
    };
    tests::RandomNumbers random(88);
    for (int i = 0; i < 100; ++i) {
        const double elevation = random.between(2, 89), height = random.between(-8, 89),
                     azimuth = random.between(1, 179);
        const auto direction = [](double elevation_deg, double azimuth_deg) {
            const auto [up, along] = sin_cos_deg(elevation_deg);
            const auto [east, north] = sin_cos_deg(azimuth_deg);
            return Vec3d{along * east, up, -along * north};
        };
        const Vec3d axis = direction(random.between(-90, 90), random.between(0, 360));
        const Affine3 turn = Affine3::rotate_deg(random.between(0, 360), axis);
        const auto turned = [&](Vec3d v) { return turn.vector(v); };
        const Vec3d up{0, 1, 0}, sun = direction(height, 0);
        const double before = seen(up, direction(elevation, azimuth), sun);
        EXPECT_NEAR(seen(turned(up), turned(direction(elevation, azimuth)), turned(sun)) / before, 1, 1e-12)
            << i;
        EXPECT_NEAR(seen(up, direction(elevation, -azimuth), sun) / before, 1, 1e-12) << i;
    }
}
