// Irradiance of a horizontal surface under the sky.
//
// Units   over the sun's irradiance above the air; of the upper half of directions, whatever the altitude.
// Errors  of the quadrature: 4e-3 of the light scattered once, at g = 0.95.
// Cost    32 x 20 lines of sight.
#pragma once

#include "renderer/sky/scattered_light.h"
#include "renderer/sky/single_scattering.h"

namespace renderer {

struct SkyIrradiance {
    Spectrum sun{};      // its cosine times the transmittance
    Spectrum single{};   // light of the sky that was scattered once
    Spectrum multiple{}; // twice and more; 0 without `scattered`
};

SkyIrradiance sky_irradiance(
    const Air& air, const ScatteredLight* scattered, double altitude, double mu_sun, SkyPrecision precision);

} // namespace renderer
