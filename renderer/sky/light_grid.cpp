#include "renderer/sky/light_grid.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/arc_cosine.h"

namespace renderer {

// Far from the edge, near it, at it, and beyond, where only what was scattered twice lights anything.
LightGrid::LightGrid(const Air& air, const GridResolution& resolution)
    : resolution_(resolution), height_(air.height_m), inverse_height_(static_cast<float>(1 / air.height_m)),
      out_density_(static_cast<float>(static_cast<double>(resolution.out_angles - 1) / kPi))
{
    // How far below the horizontal the horizon is from the top of the air: 7.9 degrees on earth.
    const double dip_deg =
        static_cast<double>(arc_cosine(static_cast<float>(air.radius_m / (air.radius_m + air.height_m)))) *
        180 / kPi;
    const double step = resolution.sun_step_deg;
    const double edges[] = {0,
                            std::max(0.0, 90 - 1.5 * dip_deg),
                            std::max(0.0, 90 - 0.6 * dip_deg),
                            std::min(176.0, 90 + 1.3 * dip_deg),
                            std::min(180.0, 90 + 3 * dip_deg)};
    const double steps[] = {12 * step, 4 * step, step, 4 * step};
    double first = 0;
    for (int i = 0; i < 4; ++i) {
        const double count = std::max(1.0, std::ceil((edges[i + 1] - edges[i]) / steps[i]));
        const double width = std::max(1e-9, edges[i + 1] - edges[i]) * kPi / 180;
        regions_[i] = {static_cast<float>(edges[i] * kPi / 180),
                       static_cast<float>(first),
                       static_cast<float>(count / width)};
        first += count;
    }
    suns_ = static_cast<std::size_t>(first) + 1;
}

double LightGrid::sun_zenith_deg(std::size_t k) const
{
    const float at = static_cast<float>(k);
    int i = 3;
    while (i > 0 && at < regions_[i].first)
        --i;
    return static_cast<double>(regions_[i].from + (at - regions_[i].first) / regions_[i].density) * 180 / kPi;
}

} // namespace renderer
