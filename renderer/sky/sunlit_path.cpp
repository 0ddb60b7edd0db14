#include "renderer/sky/sunlit_path.h"

#include "renderer/sky/sky_sun.h"

#include <algorithm>

namespace renderer {

void add_sunlight(const Air& air,
                  const ColumnTable& columns,
                  const LightPath& path,
                  double mu_sun,
                  double nu,
                  Lanes* parts,
                  std::size_t stride)
{
    const std::size_t n = path.places.size(), groups = lane_groups(air.wavelengths);
    for (std::size_t i = 0; i < n; ++i) {
        const LightPath::Place& place = path.places[i];
        const double here = (path.start_radius * mu_sun + place.along * nu) * place.inverse_radius;
        const SunThroughAir sun(air, columns, place.altitude, std::clamp(here, -1.0, 1.0));
        if (sun.hidden()) continue;
        for (std::size_t g = 0; g < groups; ++g) {
            const Lanes reaching = sun.transmittance(air, g);
            parts[g * stride] += path.rayleigh[g * n + i] * reaching;
            parts[g * stride + 1] += path.mie[g * n + i] * reaching;
        }
    }
}

} // namespace renderer
