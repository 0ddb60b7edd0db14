// Air: an atmosphere as the integrals use it: densities over altitude, coefficients at each wavelength.
//
// Three constituents: Rayleigh (molecules: scatter), Mie (aerosol: scatter and absorb), ozone (absorbs). Density 1 is
// that at the ground, or at the peak of the ozone's tent; it ends at the top.
//
// Units   metres, 1/m; altitudes above the ground.
// Errors  make_air takes what check_atmosphere found no fault in.
#pragma once

#include "renderer/description/atmosphere.h"
#include "renderer/math/fast_exp.h"

#include <array>
#include <cstddef>
#include <vector>

namespace renderer {

// One number a wavelength; those beyond the air's wavelengths stand idle.
using Spectrum = std::array<double, kMostWavelengths>;

// Density, or its integral along a way, of each constituent.
struct Columns {
    double rayleigh = 0, mie = 0, ozone = 0;

    friend constexpr Columns operator+(Columns a, Columns b)
    {
        return {a.rayleigh + b.rayleigh, a.mie + b.mie, a.ozone + b.ozone};
    }
    friend constexpr Columns operator-(Columns a, Columns b)
    {
        return {a.rayleigh - b.rayleigh, a.mie - b.mie, a.ozone - b.ozone};
    }
    friend constexpr Columns operator*(Columns a, double s)
    {
        return {a.rayleigh * s, a.mie * s, a.ozone * s};
    }
};

struct Air {
    double radius_m = 0; // of the ground
    double height_m = 0; // of the top above the ground
    double rayleigh_height_m = 0, mie_height_m = 0;
    double ozone_center_m = 0, ozone_half_width_m = 1;
    double g = 0;
    MiePhase phase = MiePhase::cornette_shanks;
    std::size_t wavelengths = 0;
    std::vector<double> wavelength_nm;
    std::vector<double> rayleigh, mie_scattering, mie_extinction, ozone, ground_albedo; // one a wavelength
    // Altitudes between ground and top at which an integral along a way is cut, ascending: the tent's kinks, and where
    // an exponential has fallen so far that another scale rules.
    std::vector<double> cuts;

    [[nodiscard]] Columns density(double altitude_m) const
    {
        const double from_center =
            altitude_m > ozone_center_m ? altitude_m - ozone_center_m : ozone_center_m - altitude_m;
        const double tent = 1 - from_center / ozone_half_width_m;
        return {fast_exp(-altitude_m / rayleigh_height_m),
                fast_exp(-altitude_m / mie_height_m),
                tent > 0 ? tent : 0};
    }
    [[nodiscard]] double optical_depth(std::size_t wavelength, const Columns& columns) const
    {
        return rayleigh[wavelength] * columns.rayleigh + mie_extinction[wavelength] * columns.mie +
               ozone[wavelength] * columns.ozone;
    }
    [[nodiscard]] double transmittance(std::size_t wavelength, const Columns& columns) const
    {
        return fast_exp(-optical_depth(wavelength, columns));
    }
};

// Lists that the description leaves empty are filled by its preset's laws.
Air make_air(const AtmosphereDescription& description);

} // namespace renderer
