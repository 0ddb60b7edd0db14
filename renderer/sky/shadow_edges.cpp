#include "renderer/sky/shadow_edges.h"

#include <cmath>

namespace renderer {

std::vector<double> shadow_edges(double planet_radius, const SkyGeometry& geometry)
{
    // |p - (p.s) s|^2 = R^2 along p = eye + t view, s towards the sun: a t^2 + 2 b t + c = 0. c is told by how high the
    // sun's ray through the eye passes above the ground, so that it has its digits at planet scale.
    const double r = planet_radius + geometry.altitude_m, mu = geometry.mu, sun = geometry.mu_sun,
                 nu = geometry.nu;
    const double passes = PlanetRay(planet_radius, geometry.altitude_m, sun).perigee();
    const double a = (1 - nu) * (1 + nu), b = r * (mu - sun * nu), c = passes * (2 * planet_radius + passes);
    const double d = b * b - a * c;
    if (!(d > 0)) return {};
    const double q = -(b + std::copysign(std::sqrt(d), b));
    std::vector<double> edges;
    for (const double t : {q / a, c / q})
        if (std::isfinite(t) && t > 0 && r * sun + t * nu < 0) edges.push_back(t);
    return edges;
}

} // namespace renderer
