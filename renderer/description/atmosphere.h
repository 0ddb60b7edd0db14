// AtmosphereDescription: a planet's air, its sun and where in it the world's origin lies, as a user wrote it.
//
// Coefficients are one a wavelength, 1/m, at the ground (ozone: at its peak). A list left empty is filled by the
// preset's law at `wavelengths_nm` (sky/air.h); the member initialisers are the preset `earth`.
//
// Source  earth, reference_b: Bruneton, "A Qualitative and Quantitative Evaluation of 8 Clear Sky Models", 2017, and
//         its demo: Rayleigh 1.24062e-6 lambda^-4 (um), Mie of optical depth 5.328e-3, albedo 0.9, g 0.8, ozone of
//         300 DU in a tent. reference_r: the Rayleigh part alone; reference_s: Rayleigh, and Mie of 21e-6, extinction
//         1.1 times it, g 0.76, no ozone. mars: sky/air.cpp.
#pragma once

#include "renderer/color/rgb.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace renderer {

enum class AtmospherePreset : std::uint8_t { earth, mars, reference_r, reference_s, reference_b };
enum class MiePhase : std::uint8_t { cornette_shanks, henyey_greenstein };
enum class SkyScattering : std::uint8_t { single, multiple };
enum class SkyMode : std::uint8_t { automatic, exact, fast };

struct PlanetDescription {
    double radius_m = 6'360'000;
    double top_m = 6'420'000;          // from the planet's centre: beyond it there is no air
    std::vector<double> ground_albedo; // one, or one a wavelength; empty: the preset's
    friend bool operator==(const PlanetDescription&, const PlanetDescription&) = default;
};

struct RayleighDescription {
    std::vector<double> scattering;
    double scale_height_m = 8000;
    friend bool operator==(const RayleighDescription&, const RayleighDescription&) = default;
};

struct MieDescription {
    std::vector<double> scattering;
    std::vector<double> extinction; // scattering and absorption together
    double g = 0.8;                 // asymmetry parameter of the phase function, in (-1, 1)
    double scale_height_m = 1200;
    MiePhase phase = MiePhase::cornette_shanks;
    friend bool operator==(const MieDescription&, const MieDescription&) = default;
};

// Absorption alone; its density is a tent over altitude.
struct OzoneDescription {
    std::vector<double> absorption; // at the tent's peak
    double center_m = 25'000;
    double half_width_m = 15'000;
    friend bool operator==(const OzoneDescription&, const OzoneDescription&) = default;
};

struct SkySunDescription {
    double elevation_deg = 45;           // above the horizon of the world's origin; below 0: night
    double azimuth_deg = 0;              // from -z towards +x
    Rgb irradiance{1.5f, 1.5f, 1.5f};    // W/m^2 a channel on a facing surface above the air
    double angular_radius_deg = 0.26785; // 0.004675 rad
    bool limb_darkening = false;
    friend bool operator==(const SkySunDescription&, const SkySunDescription&) = default;
};

inline constexpr std::size_t kMostWavelengths = 64;

struct AtmosphereDescription {
    AtmospherePreset preset = AtmospherePreset::earth;
    std::vector<double> wavelengths_nm{680, 550, 440};
    PlanetDescription planet;
    RayleighDescription rayleigh;
    MieDescription mie;
    OzoneDescription ozone;
    SkySunDescription sun;
    double altitude_m = 0; // of the world's origin above the ground
    SkyScattering scattering = SkyScattering::multiple;
    SkyMode mode = SkyMode::automatic;
    bool aerial_perspective = true; // the air between camera and objects counts
    friend bool operator==(const AtmosphereDescription&, const AtmosphereDescription&) = default;
};

// What stands where a user names the preset alone.
AtmosphereDescription atmosphere_preset(AtmospherePreset preset);

} // namespace renderer
