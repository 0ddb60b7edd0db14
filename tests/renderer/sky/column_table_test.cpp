#include "renderer/sky/column_table.h"
#include "renderer/sky/optical_depth.h"
#include "tests/support/random_numbers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace renderer;

namespace {

struct TableError {
    double worst = 0, rms = 0;
};

// Of optical depths below 5, beyond which less than a hundredth passes; half of the directions are near the horizon.
TableError error_of(AtmospherePreset preset)
{
    const Air air = make_air(atmosphere_preset(preset));
    ThreadPool pool(2);
    const ColumnTable table(air, pool);
    tests::RandomNumbers random(1);
    TableError error;
    std::size_t count = 0;
    for (int i = 0; i < 20'000; ++i) {
        const double share = random.next(), t = random.next();
        const double altitude = air.height_m * share * share, r = air.radius_m + altitude;
        const double horizon = -std::sqrt(altitude * (2 * air.radius_m + altitude)) / r;
        const double mu = horizon + (1 - horizon) * t * t * t;
        const WayOut exact = columns_to_top(air, altitude, mu);
        if (exact.blocked) continue;
        for (std::size_t w = 0; w < air.wavelengths; ++w) {
            const double depth = air.optical_depth(w, exact.columns);
            if (depth > 5) continue;
            const double off = std::abs(air.optical_depth(w, table.at(altitude, mu)) - depth);
            error.worst = std::max(error.worst, off);
            error.rms += off * off;
            ++count;
        }
    }
    error.rms = std::sqrt(error.rms / static_cast<double>(count));
    return error;
}

} // namespace

TEST(ColumnTable, GivesTransmittancesToAThousandth)
{
    EXPECT_LT(error_of(AtmospherePreset::reference_s).worst, 1e-3);
    const TableError earth = error_of(AtmospherePreset::earth);
    EXPECT_LT(earth.rms, 2e-4);
    EXPECT_LT(earth.worst, 1e-3);
}

// Where the tent has a kink: along its peak and its edges. 600 nm is where ozone absorbs most.
TEST(ColumnTable, GivesTransmittancesToAThousandthAlongTheOzonesPeak)
{
    AtmosphereDescription description = atmosphere_preset(AtmospherePreset::earth);
    description.wavelengths_nm = {550, 600, 680};
    const Air air = make_air(description);
    ThreadPool pool(2);
    const ColumnTable table(air, pool);
    tests::RandomNumbers random(2);
    for (const double kink : {10'000.0, 25'000.0, 40'000.0})
        for (int i = 0; i < 500; ++i) {
            const double near = i % 2 == 0 ? 1000 : 50, perigee = kink + random.between(-near, near);
            const double altitude = random.between(perigee, air.height_m);
            const double mu =
                PlanetRay::through(air.radius_m, altitude, perigee, true).start() / (air.radius_m + altitude);
            const WayOut exact = columns_to_top(air, altitude, mu);
            for (std::size_t w = 0; w < air.wavelengths; ++w)
                EXPECT_NEAR(
                    air.optical_depth(w, table.at(altitude, mu)), air.optical_depth(w, exact.columns), 1e-3)
                    << altitude << ' ' << perigee << ' ' << air.wavelength_nm[w];
        }
}

TEST(ColumnTable, EndsWithTheAir)
{
    const Air air = make_air(atmosphere_preset(AtmospherePreset::earth));
    ThreadPool pool(1);
    const ColumnTable table(air, pool);
    EXPECT_EQ(table.at(60'000, 0.5).rayleigh, 0);
    EXPECT_NEAR(table.at(0, 1).ozone, 15'000, 1e-6);
    EXPECT_TRUE(std::isfinite(table.at(0, -1).rayleigh)); // cut to the horizon
    for (const double mu : {1.0, 0.3, 0.0, -0.05}) {
        const Columns last = table.at(std::nextafter(air.height_m, 0), mu),
                      exact = columns_to_top(air, air.height_m, mu).columns;
        EXPECT_NEAR(last.ozone, exact.ozone, 1) << mu;
    }
}
