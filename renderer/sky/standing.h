// Standing: where a point of the world stands over the planet; and where the sun stands over the world.
//
// Frame   y up at the world's origin, which lies `origin_altitude` above the ground; the planet's centre is straight below.
// Units   metres.
#pragma once

#include "renderer/description/atmosphere.h"
#include "renderer/math/transcendental.h"
#include "renderer/math/vec3.h"

#include <algorithm>
#include <cmath>

namespace renderer {

struct Standing {
    double above_ground = 0; // below 0: under it
    double radius = 1;       // from the planet's centre
    Vec3d up;

    Standing(double planet_radius, double origin_altitude, Vec3d p)
    {
        const double h = origin_altitude + p.y, across2 = p.x * p.x + p.z * p.z;
        radius = std::sqrt(across2 + (planet_radius + h) * (planet_radius + h));
        above_ground = (across2 + h * (2 * planet_radius + h)) / (planet_radius + radius);
        up = Vec3d{p.x, planet_radius + h, p.z} / radius;
    }
    // Points below the ground are taken as on it.
    [[nodiscard]] double altitude() const { return std::max(0.0, above_ground); }
};

inline Vec3d direction_of_sun(const SkySunDescription& sun)
{
    const auto [sine, cosine] = sin_cos_deg(sun.elevation_deg);
    const auto [east, north] = sin_cos_deg(sun.azimuth_deg);
    return {cosine * east, sine, -cosine * north};
}

} // namespace renderer
