#include "renderer/description/atmosphere.h"

namespace renderer {

AtmosphereDescription atmosphere_preset(AtmospherePreset preset)
{
    AtmosphereDescription atmosphere;
    atmosphere.preset = preset;
    switch (preset) {
    case AtmospherePreset::earth:
    case AtmospherePreset::reference_r:
    case AtmospherePreset::reference_b:
        break;
    case AtmospherePreset::reference_s:
        atmosphere.mie.g = 0.76;
        break;
    case AtmospherePreset::mars:
        atmosphere.planet.radius_m = 3'389'500;
        atmosphere.planet.top_m = 3'489'500;
        atmosphere.rayleigh.scale_height_m = 11'100;
        atmosphere.mie.scale_height_m = 11'100; // dust is well mixed
        atmosphere.mie.g = 0.65;
        atmosphere.sun.irradiance = {0.65f, 0.65f, 0.65f}; // at 1.52 times the earth's distance
        atmosphere.sun.angular_radius_deg = 0.175;
        break;
    }
    return atmosphere;
}

} // namespace renderer
