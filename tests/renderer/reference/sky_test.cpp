// The sky against the tables of ../shared/reference/sky: quadrature and Monte Carlo of another program.
#include "renderer/math/transcendental.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/scattered_light.h"
#include "renderer/sky/sky_irradiance.h"
#include "tests/support/reference_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

using namespace renderer;
using tests::TableRow;

namespace {

const char* const kAbsent = "../shared/reference/sky is absent";

AtmosphereDescription reference(const std::string& letter)
{
    return atmosphere_preset(letter == "R"   ? AtmospherePreset::reference_r
                             : letter == "S" ? AtmospherePreset::reference_s
                                             : AtmospherePreset::reference_b);
}

const Air& air_of(const TableRow& row)
{
    static const std::map<std::string, Air> airs{
        {"R", make_air(reference("R"))}, {"S", make_air(reference("S"))}, {"B", make_air(reference("B"))}};
    return airs.at(row.text("atm"));
}

std::size_t wavelength(const TableRow& row)
{
    const std::string& nm = row.text("lambda_nm");
    return nm == "680" ? 0 : nm == "550" ? 1 : 2;
}

SkyGeometry geometry_of(const TableRow& row, double altitude)
{
    return SkyGeometry::from_angles_deg(
        altitude, row.number("sun_zenith_deg"), row.number("view_zenith_deg"), row.number("az_deg"));
}

// Relative above 1e-8, absolute below.
double error_of(double value, double reference)
{
    return reference > 1e-8 ? std::abs(value / reference - 1) : std::abs(value - reference);
}

double whole(const SingleScattering& sky, std::size_t w)
{
    return sky.air[w] + sky.ground[w];
}

// What differs from Monte Carlo by no more than its own error, or 3 %.
double allowed(double value, double standard_error)
{
    return std::max(4 * standard_error, 0.03 * value) + 1e-6;
}

struct Sky {
    Air air;
    ThreadPool pool;
    ColumnTable columns;
    ScatteredLight scattered;

    explicit Sky(const AtmosphereDescription& description, const GridResolution& resolution)
        : air(make_air(description)), columns(air, pool), scattered(air, columns, resolution, pool)
    {
    }
};

} // namespace

TEST(ReferenceSky, HasTheTransmittances)
{
    const auto rows = tests::reference_table("sky/transmittance.csv");
    if (rows.empty()) GTEST_SKIP() << kAbsent;
    for (const TableRow& row : rows) {
        const Air& air = air_of(row);
        const double mu = sin_cos_deg(row.number("zenith_deg")).second, exact = row.number("transmittance");
        const WayOut out = columns_to_top(air, row.number("altitude_m"), mu);
        EXPECT_EQ(out.blocked, exact == 0);
        if (out.blocked) continue;
        EXPECT_NEAR(air.transmittance(wavelength(row), out.columns), exact, 1e-6 * exact);
    }
}

TEST(ReferenceSky, HasTheTransmittancesByLookUp)
{
    const auto rows = tests::reference_table("sky/transmittance.csv");
    if (rows.empty()) GTEST_SKIP() << kAbsent;
    ThreadPool pool;
    std::map<std::string, std::unique_ptr<ColumnTable>> tables;
    for (const TableRow& row : rows) {
        auto& table = tables[row.text("atm")];
        if (!table) table = std::make_unique<ColumnTable>(air_of(row), pool);
        const double mu = sin_cos_deg(row.number("zenith_deg")).second, exact = row.number("transmittance");
        if (exact == 0) continue;
        const double found =
            air_of(row).transmittance(wavelength(row), table->at(row.number("altitude_m"), mu));
        EXPECT_NEAR(found, exact, 1e-3 * exact) << row.text("altitude_m") << ' ' << row.text("zenith_deg");
    }
}

TEST(ReferenceSky, HasTheSingleScattering)
{
    const auto rows = tests::reference_table("sky/single_scattering.csv");
    if (rows.empty()) GTEST_SKIP() << kAbsent;
    for (const TableRow& row : rows) {
        const SkyGeometry geometry = geometry_of(row, row.number("altitude_m"));
        const double exact = row.number("L_over_E0");
        const std::size_t w = wavelength(row);
        EXPECT_LE(error_of(whole(single_scattering(air_of(row), geometry, SkyPrecision::exact), w), exact),
                  1e-4);
        EXPECT_LE(error_of(whole(single_scattering(air_of(row), geometry, SkyPrecision::quick), w), exact),
                  5e-3);
    }
}

TEST(ReferenceSky, HasTheLimbFromSpace)
{
    const auto rows = tests::reference_table("sky/limb_from_space.csv");
    if (rows.empty()) GTEST_SKIP() << kAbsent;
    for (const TableRow& row : rows) {
        const Air& air = air_of(row);
        const double altitude = row.number("altitude_m"), tangent = row.number("tangent_height_m");
        const SkyGeometry geometry = SkyGeometry::towards_tangent_deg(
            air.radius_m, altitude, tangent, row.number("sun_zenith_deg"), row.number("az_deg"));
        const PlanetRay ray = tangent < 0 ? PlanetRay(air.radius_m, altitude, -1)
                                          : PlanetRay::through(air.radius_m, altitude, tangent, true);
        const std::size_t w = wavelength(row);
        const SingleScattering exact = single_scattering(air, ray, geometry, SkyPrecision::exact);
        EXPECT_EQ(exact.hits_ground, row.text("hits_ground") == "1");
        EXPECT_LE(error_of(whole(exact, w), row.number("L_over_E0")), 1e-4);
        const SingleScattering quick = single_scattering(air, ray, geometry, SkyPrecision::quick);
        EXPECT_LE(error_of(whole(quick, w), row.number("L_over_E0")), 5e-3);
        EXPECT_TRUE(tangent <= air.height_m || whole(exact, w) == 0);
    }
}

class ReferenceSkyOf : public testing::TestWithParam<std::string> {};

TEST_P(ReferenceSkyOf, HasTheHigherOrders)
{
    const auto rows = tests::reference_table("sky/multiple_scattering.csv");
    if (rows.empty()) GTEST_SKIP() << kAbsent;
    const Sky sky(reference(GetParam()), GridResolution{});
    double sum = 0;
    int count = 0;
    for (const TableRow& row : rows) {
        if (row.text("atm") != GetParam()) continue;
        const SkyGeometry geometry = geometry_of(row, 0);
        const LightPath path = sky.scattered.path(PlanetRay(sky.air.radius_m, 0, geometry.mu));
        const double found = sky.scattered.radiance(path, geometry.mu_sun, geometry.nu)[wavelength(row)];
        const double expected = row.number("Lms");
        EXPECT_NEAR(found, expected, allowed(expected, row.number("se")))
            << row.text("lambda_nm") << ' ' << row.text("sun_zenith_deg") << ' '
            << row.text("view_zenith_deg") << ' ' << row.text("az_deg");
        sum += found / expected - 1;
        ++count;
    }
    EXPECT_NEAR(sum / count, 0, 0.004); // and no drift: Monte Carlo's own errors cancel
    for (const TableRow& row : tests::reference_table("sky/sky_irradiance.csv")) {
        if (row.text("atm") != GetParam()) continue;
        const SkyIrradiance found = sky_irradiance(sky.air,
                                                   &sky.scattered,
                                                   0,
                                                   sin_cos_deg(row.number("sun_zenith_deg")).second,
                                                   SkyPrecision::quick);
        const std::size_t w = wavelength(row);
        EXPECT_NEAR(found.sun[w], row.number("Esun"), 1e-6 * row.number("Esun") + 1e-15);
        EXPECT_NEAR(found.single[w], row.number("E1"), 2e-3 * row.number("E1"));
        EXPECT_NEAR(found.multiple[w], row.number("Ems"), allowed(row.number("Ems"), row.number("se")));
    }
}

INSTANTIATE_TEST_SUITE_P(Atmospheres, ReferenceSkyOf, testing::Values("R", "S", "B"));
