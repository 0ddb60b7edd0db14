#include "renderer/math/transcendental.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/sky.h"

#include <gtest/gtest.h>

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
