// Columns of air along a straight way: what the transmittance is made of.
//
// Source  the integrals of Bruneton, Neyret 2008, eq. 1, by Gauss-Legendre quadrature on pieces cut at the closest
//         approach, at the kinks of the densities and where an exponential leaves the scale of its piece.
// Errors  1e-9 of the column where scale heights are those of a planet's air; none where a way is empty.
// Cost    some 16 to 200 densities.
#pragma once

#include "renderer/sky/air.h"
#include "renderer/sky/planet_ray.h"

namespace renderer {

// From u = `begin` to `end` on the ray, both within the air.
Columns columns_along(const Air& air, const PlanetRay& ray, double begin, double end);

// From a point to the top of the air; `blocked` where the ground is in the way, and then the columns are of no use.
struct WayOut {
    Columns columns;
    bool blocked = false;
};
WayOut columns_to_top(const Air& air, double altitude, double mu);
// Without asking whether the ground is in the way: for points that are known to be lit.
Columns columns_past_ground(const Air& air, double altitude, double mu);

} // namespace renderer
