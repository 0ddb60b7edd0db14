// color_error: how far off the colours of sky and sun are because the air is known at few wavelengths.
//
// Against a dense set of wavelengths, one each 10 nm from 385 to 735 nm, weighted as SkyColor weights them; of light scattered once.
// Units   relative: root mean square over directions and channels, over the mean.
// Cost    6 ms of a core, mostly the dense wavelengths.
// Threads any number at once.
#pragma once

#include "renderer/description/atmosphere.h"

#include <cstddef>
#include <optional>

namespace renderer {

inline constexpr std::size_t kDenseWavelengths = 36;

struct ColorError {
    double sky = 0; // over all directions that have air or ground before them
    double sun = 0; // of what the air lets through; 0 where the ground hides it
};

// Seen from an altitude under a sun whose cosine to the vertical is mu_sun. Nothing where it cannot be known: coefficients
// that are listed wavelength by wavelength say nothing of those between; and where nothing is lit.
std::optional<ColorError>
color_error(const AtmosphereDescription& description, double altitude_m, double mu_sun);

} // namespace renderer
