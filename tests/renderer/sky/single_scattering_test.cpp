#include "renderer/math/transcendental.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/single_scattering.h"
#include "tests/support/random_numbers.h"
#include "tests/support/sky_march.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <utility>

using namespace renderer;

namespace {

constexpr double kEarth = 6'360'000;

Air reference_s()
{
    return make_air(atmosphere_preset(AtmospherePreset::reference_s));
}

double blue(const Air& air, const SkyGeometry& geometry)
{
    const SingleScattering sky = single_scattering(air, geometry, SkyPrecision::exact);
    return sky.air[2] + sky.ground[2];
}

AtmosphereDescription scaled(double scale)
{
    AtmosphereDescription d = atmosphere_preset(AtmospherePreset::reference_b);
    const Air air = make_air(d);
    const auto thinner = [&](const std::vector<double>& list) {
        std::vector<double> result;
        for (const double x : list)
            result.push_back(x / scale);
        return result;
    };
    d.planet.radius_m *= scale;
    d.planet.top_m *= scale;
    d.rayleigh = {thinner(air.rayleigh), d.rayleigh.scale_height_m * scale};
    d.mie.scattering = thinner(air.mie_scattering);
    d.mie.extinction = thinner(air.mie_extinction);
    d.mie.scale_height_m *= scale;
    d.ozone = {thinner(air.ozone), d.ozone.center_m * scale, d.ozone.half_width_m * scale};
    return d;
}

} // namespace

TEST(SingleScattering, IsContinuousFromTheGroundToTenRadii)
{
    const Air air = make_air(atmosphere_preset(AtmospherePreset::reference_b));
    for (int frame = 0; frame < 200; ++frame) {
        const double altitude = 1.7 * std::pow(10 * kEarth / 1.7, frame / 199.0), step = altitude * 1e-4;
        for (const double view : {70.0, 100.0, 180.0}) {
            const auto at = [&](double h) {
                return blue(air, SkyGeometry::from_angles_deg(h, 60, view, 30));
            };
            const double here = at(altitude), below = at(altitude - step), above = at(altitude + step);
            EXPECT_LE(std::abs(below - 2 * here + above), 1e-3 * std::max({here, below, above}))
                << altitude << ' ' << view;
        }
    }
}

TEST(SingleScattering, DoesNotStepWhereTheAirEnds)
{
    const Air air = reference_s();
    for (const double tangent : {-1.0, 0.0, 10'000.0, 36'000.0, 50'000.0}) {
        const auto at = [&](double altitude) {
            const SkyGeometry geometry = SkyGeometry::towards_tangent_deg(kEarth, altitude, tangent, 45, 0);
            const PlanetRay ray = tangent < 0 ? PlanetRay(kEarth, altitude, -1)
                                              : PlanetRay::through(kEarth, altitude, tangent, true);
            return single_scattering(air, ray, geometry, SkyPrecision::exact).air[2];
        };
        EXPECT_NEAR(at(60'001) / at(59'999), 1, 1e-4) << tangent;
    }
    EXPECT_EQ(blue(air, SkyGeometry::from_angles_deg(60'000, 45, 80, 0)), 0);
    EXPECT_EQ(blue(air, SkyGeometry::from_angles_deg(1e6, 45, 0, 0)), 0);
}

TEST(SingleScattering, HasNoStripeAtTheHorizon)
{
    const Air air = reference_s();
    for (const double altitude : {1.7, 10'000.0, 400'000.0}) {
        const double r = kEarth + altitude, dip = -std::sqrt(altitude * (2 * kEarth + altitude)) / r;
        double before = -1;
        for (const double off : {-1e-9, -1e-12, 0.0, 1e-12, 1e-9}) {
            SkyGeometry geometry = SkyGeometry::from_angles_deg(altitude, 60, 90, 0);
            geometry.mu = dip + off;
            geometry.nu = geometry.mu * 0.5 + std::sqrt(1 - geometry.mu * geometry.mu) * std::sqrt(0.75);
            const SingleScattering sky = single_scattering(air, geometry, SkyPrecision::exact);
            ASSERT_TRUE(std::isfinite(sky.air[0]));
            if (off > 0 && before > 0) {
                EXPECT_NEAR(sky.air[0] / before, 1, 1e-5) << altitude;
            }
            if (off > 0) before = sky.air[0];
        }
    }
}

TEST(SingleScattering, FadesThroughDuskToNothing)
{
    const Air air = reference_s();
    double before = 1;
    for (const double below : {-10.0, 0.0, 1.0, 6.0, 12.0}) {
        const double now = blue(air, SkyGeometry::from_angles_deg(0, 90 + below, 30, 0));
        EXPECT_LT(now, before) << below;
        before = now;
    }
    EXPECT_EQ(blue(air, SkyGeometry::from_angles_deg(0, 108, 0, 0)), 0); // the air above is in full shadow
    EXPECT_EQ(blue(air, SkyGeometry::from_angles_deg(1e7, 180, 180, 0)), 0); // the night side from space
}

TEST(SingleScattering, IsTheSameForAPlanetOfAnySize)
{
    const Air earth = make_air(scaled(1));
    for (const double radius : {1.0, 1000.0, 7e8}) {
        const double scale = radius / kEarth;
        const Air other = make_air(scaled(scale));
        for (const double altitude : {0.0, 2000.0, 1e6})
            for (const double view : {0.0, 88.0, 100.0, 170.0})
                for (const double sun : {20.0, 91.0}) {
                    const double here = blue(earth, SkyGeometry::from_angles_deg(altitude, sun, view, 40));
                    const double there =
                        blue(other, SkyGeometry::from_angles_deg(altitude * scale, sun, view, 40));
                    EXPECT_NEAR(there, here, 1e-9 * here)
                        << radius << ' ' << altitude << ' ' << view << ' ' << sun;
                }
    }
}

TEST(SingleScattering, WithoutAirIsBlackAndWithVeryMuchIsFinite)
{
    AtmosphereDescription d = atmosphere_preset(AtmospherePreset::reference_r);
    d.rayleigh.scattering = {0, 0, 0};
    const Air none = make_air(d);
    EXPECT_EQ(blue(none, SkyGeometry::from_angles_deg(0, 30, 60, 0)), 0);
    for (const double mu : {1.0, 0.5, 0.0})
        EXPECT_EQ(none.transmittance(2, columns_to_top(none, 0, mu).columns), 1) << mu;
    d.rayleigh.scattering = {1.25, 1.25, 1.25}; // an optical depth of 1e4
    const Air thick = make_air(d);
    for (const double altitude : {0.0, 30'000.0, 50'000.0})
        for (const double view : {0.0, 80.0, 120.0}) {
            const double value = blue(thick, SkyGeometry::from_angles_deg(altitude, 30, view, 0));
            EXPECT_TRUE(std::isfinite(value) && value >= 0) << altitude << ' ' << view;
        }
    // Seen from above, light returns from the first optical depths alone: P / (1 + mu / mu_sun), flat to H / R.
    const double back = blue(thick, SkyGeometry::from_angles_deg(60'000, 0, 180, 0));
    EXPECT_NEAR(back, 3 / (8 * kPi) / 2, 0.01 * back);
}

TEST(SingleScattering, IsTheSameLeftAndRightOfTheSun)
{
    const Air air = reference_s();
    for (const double azimuth : {17.0, 90.0, 163.0})
        EXPECT_NEAR(blue(air, SkyGeometry::from_angles_deg(0, 40, 70, azimuth)) /
                        blue(air, SkyGeometry::from_angles_deg(0, 40, 70, -azimuth)),
                    1,
                    1e-12);
}

TEST(SingleScattering, QuickIsNearExact)
{
    const Air air = make_air(atmosphere_preset(AtmospherePreset::earth));
    tests::RandomNumbers random(3);
    for (int i = 0; i < 300; ++i) {
        const double altitude = i % 3 == 0 ? 0 : std::pow(10, random.between(0, 6));
        const SkyGeometry geometry = SkyGeometry::from_angles_deg(
            altitude, random.between(0, 96), random.between(0, 180), random.between(0, 180));
        const SingleScattering exact = single_scattering(air, geometry, SkyPrecision::exact);
        const SingleScattering quick = single_scattering(air, geometry, SkyPrecision::quick);
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            EXPECT_NEAR(quick.air[w], exact.air[w], 5e-3 * exact.air[w] + 1e-9) << altitude << ' ' << i;
    }
}

// Along the ground light comes from the first tenth of the way or from far off; through an edge of the tent, from a part.
TEST(SingleScattering, QuickIsNearExactAlongTheGroundAndPastTheOzone)
{
    AtmosphereDescription thick = atmosphere_preset(AtmospherePreset::earth), low = thick, wide = thick;
    thick.mie.scattering = {1e-3};
    thick.mie.scale_height_m = 60;
    low.planet.top_m = low.planet.radius_m + 100'000;
    low.ozone = {{4e-5}, 10'000, 10'000};
    wide.planet.radius_m = 2'575'000;
    wide.planet.top_m = 3'200'000;
    wide.rayleigh.scale_height_m = 40'000;
    wide.mie = {{2e-5}, {3e-5}, 0.6, 50'000, MiePhase::cornette_shanks};
    for (const AtmosphereDescription& d : {atmosphere_preset(AtmospherePreset::mars), thick, low, wide}) {
        const Air air = make_air(d);
        const double above = air.height_m + 1;
        for (const auto& [altitude, view] :
             {std::pair{0.0, 90.0}, {0.0, 89.99}, {1.0, 90.0}, {1000.0, 90.0}, {above, 100.1}, {above, 95.0}})
            for (const double sun : {0.0, 60.0, 85.0, 90.0, 95.1, 100.0})
                for (const double azimuth : {0.0, 90.0, 180.0}) {
                    const SkyGeometry geometry = SkyGeometry::from_angles_deg(altitude, sun, view, azimuth);
                    const SingleScattering exact = single_scattering(air, geometry, SkyPrecision::exact);
                    const SingleScattering quick = single_scattering(air, geometry, SkyPrecision::quick);
                    for (std::size_t w = 0; w < air.wavelengths; ++w)
                        EXPECT_NEAR(quick.air[w], exact.air[w], 5e-3 * exact.air[w] + 1e-10)
                            << air.radius_m << ' ' << air.mie_height_m << ' ' << altitude << ' ' << view
                            << ' ' << sun << ' ' << azimuth;
                }
    }
}

// T90: a march of half steps comes nearer by the square of its steps, one of whole steps in proportion.
TEST(SingleScattering, IsWhatRayMarchesComeTo)
{
    const Air air = make_air(atmosphere_preset(AtmospherePreset::reference_r));
    const SkyGeometry geometry = SkyGeometry::from_angles_deg(0, 40, 30, 60);
    const double exact = single_scattering(air, geometry, SkyPrecision::exact).air[2];
    const auto error = [&](tests::MarchSteps steps, int n) {
        return std::abs(tests::march(air, geometry, steps, n, n)[2] / exact - 1);
    };
    EXPECT_NEAR(
        std::log2(error(tests::MarchSteps::half, 256) / error(tests::MarchSteps::half, 128)), -2, 0.2);
    EXPECT_NEAR(
        std::log2(error(tests::MarchSteps::whole, 256) / error(tests::MarchSteps::whole, 128)), -1, 0.2);
}
