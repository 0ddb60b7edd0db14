// tent_column: the column of a density that is a tent over altitude, 1 at its peak, along a straight way.
//
// In closed form: a table would have to follow its kinks, which ways that graze the peak see as roots.
//
// Units   metres; begin and end are places on the ray; 0 where end is not beyond begin.
// Errors  where the planet is large a few 1e-16 R^2 over the tent's half width: 1e-6 m of 15 km for the earth's.
// Cost    30 to 60 ns.
#pragma once

#include "renderer/sky/planet_ray.h"

namespace renderer {

double tent_column(double center_m,
                   double half_width_m,
                   double planet_radius,
                   const PlanetRay& ray,
                   double begin,
                   double end);

} // namespace renderer
