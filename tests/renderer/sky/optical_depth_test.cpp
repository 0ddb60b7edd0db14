#include "renderer/math/transcendental.h"
#include "renderer/sky/optical_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

using namespace renderer;

namespace {

Air reference_s()
{
    return make_air(atmosphere_preset(AtmospherePreset::reference_s));
}

} // namespace

TEST(OpticalDepth, OfTheVerticalIsClosedForm)
{
    const Air air = reference_s();
    const Columns up = columns_to_top(air, 0, 1).columns;
    for (std::size_t w = 0; w < air.wavelengths; ++w) {
        const double exact = air.rayleigh[w] * 8000 * -std::expm1(-60'000.0 / 8000) +
                             air.mie_extinction[w] * 1200 * -std::expm1(-60'000.0 / 1200);
        EXPECT_NEAR(air.optical_depth(w, up) / exact, 1, 1e-10);
    }
}

// Huestis 2001: X = 795, along the horizon, without a top.
TEST(OpticalDepth, OfTheHorizonIsChapmansFunction)
{
    AtmosphereDescription description = atmosphere_preset(AtmospherePreset::reference_r);
    description.planet.radius_m = 795 * 8000;
    description.planet.top_m = description.planet.radius_m + 100 * 8000;
    const Columns level = columns_to_top(make_air(description), 0, 0).columns;
    EXPECT_NEAR(level.rayleigh / 8000, 35.35478740, 1e-8);
}

TEST(OpticalDepth, OfTheOzoneTentIsItsArea)
{
    const Air air = make_air(atmosphere_preset(AtmospherePreset::reference_b));
    EXPECT_NEAR(columns_to_top(air, 0, 1).columns.ozone, 15'000, 1e-6);
    EXPECT_NEAR(columns_to_top(air, 25'000, 1).columns.ozone, 7500, 1e-6);
}

TEST(OpticalDepth, OfAWayIsTheSumOfItsParts)
{
    const Air air = make_air(atmosphere_preset(AtmospherePreset::earth));
    for (const double perigee : {-100'000.0, 10.0, 12'000.0}) {
        const PlanetRay ray = PlanetRay::through(air.radius_m, 70'000, perigee, true);
        const PlanetRay::Reach reach = ray.reach(air.height_m);
        double before = 0;
        for (int i = 1; i < 20; ++i) {
            const double middle = reach.begin + (reach.end - reach.begin) * i / 20;
            for (std::size_t w = 0; w < air.wavelengths; ++w) {
                const auto t = [&](double a, double b) {
                    return air.transmittance(w, columns_along(air, ray, a, b));
                };
                const double whole = t(reach.begin, reach.end);
                EXPECT_NEAR(t(reach.begin, middle) * t(middle, reach.end), whole, 1e-12 * whole) << perigee;
                EXPECT_LE(t(reach.begin, middle), 1);
            }
            const double depth = air.optical_depth(0, columns_along(air, ray, reach.begin, middle));
            EXPECT_GE(depth, before);
            before = depth;
        }
    }
}

TEST(OpticalDepth, EndsAtTheGround)
{
    EXPECT_TRUE(columns_to_top(reference_s(), 1000, -1).blocked);
    EXPECT_FALSE(columns_to_top(reference_s(), 0, 0).blocked);
    EXPECT_TRUE(columns_to_top(reference_s(), 0, -1e-9).blocked);
}

TEST(OpticalDepth, TakesAirOfAnyShape)
{
    AtmosphereDescription description = atmosphere_preset(AtmospherePreset::reference_s);
    description.rayleigh.scale_height_m = 1;
    description.mie.scale_height_m = 1e9;
    const Air thin = make_air(description);
    const Columns up = columns_to_top(thin, 0, 1).columns;
    EXPECT_NEAR(up.rayleigh, 1, 1e-9);
    EXPECT_NEAR(up.mie, 60'000, 2);
    const Columns level = columns_to_top(thin, 0, 0).columns;
    EXPECT_NEAR(level.rayleigh / std::sqrt(kPi / 2 * 6'360'000), 1, 1e-6); // Gaussian: R >> H
    description.planet.radius_m = 1;
    description.planet.top_m = 1e6;
    EXPECT_NEAR(columns_to_top(make_air(description), 0, 1).columns.mie, 1e6 - 1, 600);
}
