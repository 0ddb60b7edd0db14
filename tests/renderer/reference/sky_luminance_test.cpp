// The sky in candela, of the atmosphere of Bruneton's study of eight clear sky models, at 21 wavelengths.
#include "renderer/sky/sky.h"
#include "tests/support/reference_table.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

using namespace renderer;

namespace {

// CIE 1931 luminous efficiency from 380 to 780 nm in steps of 20.
constexpr std::array kEfficiency{0.000039, 0.000396, 0.004,    0.023,    0.06,     0.13902, 0.323,
                                 0.71,     0.954,    0.995,    0.87,     0.631,    0.381,   0.175,
                                 0.061,    0.017,    0.004102, 0.001047, 0.000249, 0.00006, 0.000015};

std::map<int, double> column(const char* file, const char* name)
{
    std::map<int, double> values;
    for (const tests::TableRow& row : tests::reference_table(file))
        values[static_cast<int>(row.number("lambda_nm"))] = row.number(name);
    return values;
}

AtmosphereDescription clear_day()
{
    auto rayleigh = column("sky/rayleigh_penndorf1957.csv", "beta_15C");
    auto albedo = column("sky/grass_albedo_feister1995.csv", "albedo");
    AtmosphereDescription d = atmosphere_preset(AtmospherePreset::reference_s);
    d.wavelengths_nm.clear();
    for (int nm = 380; nm <= 780; nm += 20) {
        const double extinction = 0.04 * std::pow(nm * 1e-3, -0.8) / 1200;
        d.wavelengths_nm.push_back(nm);
        d.rayleigh.scattering.push_back(rayleigh.at(nm));
        d.mie.extinction.push_back(extinction);
        d.mie.scattering.push_back(0.8 * extinction);
        d.planet.ground_albedo.push_back(albedo.at(nm));
    }
    d.mie.g = 0.7;
    d.mode = SkyMode::fast;
    return d;
}

} // namespace

TEST(ReferenceSky, HasTheLuminanceOfAClearDay)
{
    const auto rows = tests::reference_table("sky/zenith_luminance.csv");
    if (rows.empty()) GTEST_SKIP() << "../shared/reference/sky is absent";
    auto sun = column("sky/bruneton2017_spectra.csv", "solar_W_m2_nm");
    ThreadPool pool;
    const Sky sky(clear_day(), pool);
    for (const tests::TableRow& row : rows) {
        const bool zenith = row.text("view") == "zenith";
        const double azimuth = row.text("view") == "85deg az180" ? 180 : 90;
        const SkyRadiance found = sky.radiance(
            SkyGeometry::from_angles_deg(0, row.number("sun_zenith_deg"), zenith ? 0 : 85, azimuth));
        double luminance = 0;
        for (std::size_t w = 0; w < kEfficiency.size(); ++w)
            luminance += 683 * 20 * kEfficiency[w] * sun.at(static_cast<int>(sky.air().wavelength_nm[w])) *
                         (found.single[w] + found.multiple[w]);
        EXPECT_NEAR(luminance / row.number("total_cd_m2"), 1, 0.05)
            << row.text("view") << ' ' << row.text("sun_zenith_deg");
    }
}
