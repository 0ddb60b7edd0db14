// LightPath: one line of sight cut into places where scattered light is gathered.
//
// It depends on altitude and direction to the vertical alone: every sun and azimuth share it.
//
// Units   metres; `rayleigh` and `mie` of a place: transmittance from the eye times scattering times length, no unit.
#pragma once

#include "renderer/sky/air.h"
#include "renderer/sky/lanes.h"
#include "renderer/sky/light_grid.h"
#include "renderer/sky/planet_ray.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace renderer {

struct LightPath {
    struct Place {
        double altitude = 0, along = 0; // along: from the eye
        double inverse_radius = 0;
        float mu = 0, sine = 0; // of the direction to the place's own vertical
        Between at_altitude, at_angle;
    };
    double start_radius = 0;
    std::vector<Place> places;
    std::vector<Lanes> rayleigh, mie; // [group][place]
    bool hits_ground = false;
    double ground_along = 0;
    std::vector<Lanes> ground; // transmittance to where the ground is hit, [group]
};

// `points` a side of the closest approach, and of each of `edges`: distances from the eye at which light steps. `grid`:
// null where the places are not looked up in one. The way ends at `far_m` from the eye, or where the ground is sooner.
LightPath light_path(const Air& air,
                     const LightGrid* grid,
                     const PlanetRay& ray,
                     std::size_t points,
                     const std::vector<double>& edges = {},
                     double far_m = std::numeric_limits<double>::infinity());

} // namespace renderer
