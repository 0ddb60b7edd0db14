#include "api/read_atmosphere.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using namespace renderer;

namespace {

AtmosphereDescription read(const std::string& text)
{
    auto result = api::read_atmosphere(text);
    if (const auto* problem = std::get_if<api::ProblemDetails>(&result)) {
        ADD_FAILURE() << text << ": " << problem->detail;
        return {};
    }
    return std::get<AtmosphereDescription>(result);
}

// "pointer code" of each fault.
std::vector<std::string> faults(const std::string& text)
{
    std::vector<std::string> told;
    const auto result = api::read_atmosphere(text);
    if (const auto* problem = std::get_if<api::ProblemDetails>(&result))
        for (const api::Problem& fault : problem->errors)
            told.push_back(fault.pointer + ' ' + fault.code);
    return told;
}

using Faults = std::vector<std::string>;

} // namespace

TEST(ReadAtmosphere, WithoutMembersIsTheEarth)
{
    EXPECT_EQ(read(R"({"type": "atmosphere"})"), AtmosphereDescription{});
    EXPECT_EQ(read(R"({"type": "atmosphere", "preset": "earth"})"), AtmosphereDescription{});
}

TEST(ReadAtmosphere, StartsFromItsPresetWhereverThatStands)
{
    const AtmosphereDescription s = read(
        R"({"type": "atmosphere", "mie": {"scale_height_m": 900}, "preset": "reference_s", "mode": "exact"})");
    AtmosphereDescription expected = atmosphere_preset(AtmospherePreset::reference_s);
    expected.mie.scale_height_m = 900;
    expected.mode = SkyMode::exact;
    EXPECT_EQ(s, expected);
}

TEST(ReadAtmosphere, TakesAnotherPresetInTheOnesPlace)
{
    const auto result = api::read_atmosphere(
        R"({"type": "atmosphere", "preset": "reference_s", "mode": "fast"})", AtmospherePreset::reference_r);
    AtmosphereDescription expected = atmosphere_preset(AtmospherePreset::reference_r);
    expected.mode = SkyMode::fast;
    EXPECT_EQ(std::get<AtmosphereDescription>(result), expected);
}

TEST(ReadAtmosphere, ReadsEveryMember)
{
    const AtmosphereDescription a = read(R"({"type": "atmosphere", "wavelengths_nm": [500, 600],
        "planet": {"radius_m": 1000, "top_m": 1100, "ground_albedo": [0.1, 0.2]},
        "rayleigh": {"scattering": [1e-3, 2e-3], "scale_height_m": 10},
        "mie": {"scattering": 1e-3, "extinction": 2e-3, "g": -0.5, "scale_height_m": 3, "phase": "henyey_greenstein"},
        "ozone": {"absorption": [0, 1e-4], "center_m": 40, "half_width_m": 20},
        "sun": {"elevation_deg": -3, "azimuth_deg": 120, "irradiance": [1, 2, 3], "angular_radius_deg": 0.3,
                "limb_darkening": true},
        "altitude_m": 5, "scattering": "single", "mode": "fast", "aerial_perspective": false})");
    EXPECT_EQ(a.wavelengths_nm, (std::vector<double>{500, 600}));
    EXPECT_EQ(a.planet.ground_albedo, (std::vector<double>{0.1, 0.2}));
    EXPECT_EQ(a.mie.scattering, std::vector<double>{1e-3});
    EXPECT_EQ(a.mie.phase, MiePhase::henyey_greenstein);
    EXPECT_EQ(a.ozone.center_m, 40);
    EXPECT_EQ(a.sun.elevation_deg, -3);
    EXPECT_EQ(a.sun.irradiance, (Rgb{1, 2, 3}));
    EXPECT_TRUE(a.sun.limb_darkening);
    EXPECT_EQ(a.scattering, SkyScattering::single);
    EXPECT_FALSE(a.aerial_perspective);
}

TEST(ReadAtmosphere, TellsWhatIsWrongAndWhere)
{
    const std::string head = R"({"type": "atmosphere", )";
    EXPECT_EQ(faults(head + R"("planet": {"radius_m": 0}})"), Faults{"/planet/radius_m out_of_range"});
    EXPECT_EQ(faults(head + R"("planet": {"top_m": 6000000}})"), Faults{"/planet/top_m out_of_range"});
    EXPECT_EQ(faults(head + R"("rayleigh": {"scattering": [1e-6, -1e-6, 0]}})"),
              Faults{"/rayleigh/scattering/1 out_of_range"});
    EXPECT_EQ(faults(head + R"("rayleigh": {"scale_height_m": 0}})"),
              Faults{"/rayleigh/scale_height_m out_of_range"});
    EXPECT_EQ(faults(head + R"("mie": {"g": 1}})"), Faults{"/mie/g out_of_range"});
    EXPECT_EQ(faults(head + R"("mie": {"scattering": 2e-5, "extinction": 1e-5}})"),
              Faults{"/mie/extinction conflict"});
    EXPECT_EQ(faults(head + R"("ozone": {"absorption": [1e-6, 1e-6]}})"),
              Faults{"/ozone/absorption wrong_length"});
    EXPECT_EQ(faults(head + R"("altitude_m": -1})"), Faults{"/altitude_m out_of_range"});
    EXPECT_EQ(faults(head + R"("sun": {"elevation_deg": 91}})"), Faults{"/sun/elevation_deg out_of_range"});
    EXPECT_EQ(faults(head + R"("sun": {"elevation_deg": null}})"), Faults{"/sun/elevation_deg wrong_type"});
    EXPECT_EQ(faults(head + R"("preset": "venus"})"), Faults{"/preset unknown_value"});
    EXPECT_EQ(faults(head + R"("cloud": 1})"), Faults{"/cloud unknown_member"});
    EXPECT_EQ(faults(head + R"("wavelengths_nm": []})"), Faults{"/wavelengths_nm wrong_length"});
    EXPECT_EQ(faults(head + R"("mie": {"g": 2}, "planet": {"top_m": 5}})"),
              (Faults{"/mie/g out_of_range", "/planet/top_m out_of_range"}));
    EXPECT_EQ(faults(R"({"type": "color"})"), Faults{"/type unknown_value"});
    EXPECT_EQ(faults(R"({})"), Faults{"/type missing_member"});
}
