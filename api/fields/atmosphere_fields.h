// The members of an atmosphere, said once. See job_fields.h for visitors.
#pragma once

#include "api/fields/ranges.h"
#include "api/words/word_table.h"
#include "renderer/description/atmosphere.h"

#include <concepts>
#include <type_traits>

namespace api {

inline constexpr Range kWavelength{100, 10'000};
inline constexpr Range kCoefficient{0, 1e30};
inline constexpr Range kPlanetLength{0, 1e18, true};
inline constexpr Range kHeight{0, 1e18};
inline constexpr Range kAsymmetry{-1, 1, true, true};

template <typename V, typename X>
requires std::same_as<std::remove_const_t<X>, renderer::AtmosphereDescription>
void fields(V& v, X& a)
{
    v.preset("preset", a, "what every other member left out is taken from");
    v.coefficients("wavelengths_nm",
                   a.wavelengths_nm,
                   kWavelength,
                   "at which the sky is known; three stand for red, green, blue");
    v.group("planet", "its sphere", [&](auto& p) {
        p.number("radius_m", a.planet.radius_m, kPlanetLength, "of the ground");
        p.number("top_m", a.planet.top_m, kPlanetLength, "of the air, from the planet's centre as radius_m");
        p.coefficients(
            "ground_albedo", a.planet.ground_albedo, kReflectance, "one number, or one a wavelength");
    });
    v.group("rayleigh", "molecules", [&](auto& r) {
        r.coefficients("scattering",
                       a.rayleigh.scattering,
                       kCoefficient,
                       "1/m at the ground, one a wavelength; left out: the preset's law");
        r.number("scale_height_m",
                 a.rayleigh.scale_height_m,
                 kPlanetLength,
                 "over which the density falls to 1/e");
    });
    v.group("mie", "aerosols", [&](auto& m) {
        m.coefficients("scattering",
                       a.mie.scattering,
                       kCoefficient,
                       "1/m at the ground, one a wavelength; left out: the preset's law");
        m.coefficients("extinction",
                       a.mie.extinction,
                       kCoefficient,
                       "scattering and absorption, 1/m; left out: the preset's law");
        m.number("g", a.mie.g, kAsymmetry, "asymmetry parameter of the phase function");
        m.number(
            "scale_height_m", a.mie.scale_height_m, kPlanetLength, "over which the density falls to 1/e");
        m.word("phase", a.mie.phase, "phase function");
    });
    v.group("ozone", "absorbs alone, its density a tent over altitude", [&](auto& o) {
        o.coefficients("absorption",
                       a.ozone.absorption,
                       kCoefficient,
                       "1/m at the tent's peak, one a wavelength; left out: the preset's law");
        o.number("center_m", a.ozone.center_m, kHeight, "altitude of the peak");
        o.number("half_width_m", a.ozone.half_width_m, kPlanetLength, "from the peak to where there is none");
    });
    v.group("sun", "where it stands and how bright it is", [&](auto& s) {
        s.number("elevation_deg", a.sun.elevation_deg, kElevation, "above the horizon of the world's origin");
        s.number("azimuth_deg", a.sun.azimuth_deg, kTurn, "from -z towards +x");
        s.color("irradiance",
                a.sun.irradiance,
                kRadiometric,
                "W/m^2 a channel on a facing surface above the air");
        s.number("angular_radius_deg", a.sun.angular_radius_deg, kSunRadius, "half the angle that it fills");
        s.boolean("limb_darkening", a.sun.limb_darkening, "its disk fades towards the edge");
    });
    v.number("altitude_m", a.altitude_m, kHeight, "of the world's origin above the ground");
    v.word("scattering", a.scattering, "multiple: every order; single: the first alone");
    v.word("mode", a.mode, "exact: quadrature; fast: tables; auto: chosen by use");
    v.boolean("aerial_perspective", a.aerial_perspective, "the air between camera and objects counts");
}

} // namespace api
