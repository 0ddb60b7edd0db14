// Light that leaves a thick cloud of isotropic scatterers, against Chandrasekhar's H function: all orders of scattering, in
// an air that is no planet's.
#include "renderer/math/transcendental.h"
#include "renderer/sky/sky.h"
#include "tests/support/reference_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using namespace renderer;
using tests::TableRow;

TEST(HalfSpace, ReflectsByTheProductOfTwoHFunctions)
{
    const auto rows = tests::reference_table("sky/h_function.csv");
    if (rows.empty()) GTEST_SKIP() << "the reference tables are not there";
    std::map<double, std::map<double, double>> h; // by albedo, mu
    for (const TableRow& row : rows)
        h[row.number("omega")][row.number("mu")] = row.number("H");

    // Sixty optical depths over a ground that is flat: what is below sends nothing back.
    constexpr double kDepth = 60, kScaleHeight = 8000, kTop = 80'000, kRadius = 1e10;
    ThreadPool pool(2);
    for (const double albedo : {0.5, 0.8}) {
        AtmosphereDescription d;
        d.wavelengths_nm = {550};
        d.planet = {kRadius, kRadius + kTop, {0}};
        d.rayleigh.scattering = {0};
        d.ozone.absorption = {0};
        d.mie = {{kDepth / kScaleHeight * albedo},
                 {kDepth / kScaleHeight},
                 0,
                 kScaleHeight,
                 MiePhase::henyey_greenstein};
        const Sky sky(d, pool);
        for (const double mu_sun : {0.3, 0.6, 1.0})
            for (const double mu : {0.2, 0.5, 1.0}) {
                const SkyGeometry geometry = SkyGeometry::from_angles_deg(
                    kTop, renderer::acos(mu_sun) * (180 / kPi), 180 - renderer::acos(mu) * (180 / kPi), 70);
                const SkyRadiance found = sky.radiance(geometry);
                const double expected =
                    albedo / (4 * kPi) * mu_sun / (mu + mu_sun) * h[albedo][mu] * h[albedo][mu_sun];
                // The tables have two altitudes an optical depth here, a planet's air has twenty.
                EXPECT_NEAR((found.single[0] + found.multiple[0]) / expected, 1, 0.03)
                    << albedo << ' ' << mu_sun << ' ' << mu;
            }
    }
}
