// Sphere: exact, centred at the origin; scenes place it by a transform.
//
// Source  E. Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019,
//         chapter 7: the discriminant from the point of closest approach, and the root that does not cancel.
//         We factor r^2 - d^2 as (r-d)(r+d) as well, which keeps a planet's horizon.
#pragma once

#include "renderer/geometry/ray.h"
#include "renderer/geometry/surface_point.h"

#include <optional>

namespace renderer {

struct Sphere {
    double radius;
};

// The first t in the ray's range, entering or leaving.
std::optional<double> intersect(const Sphere& sphere, const Ray& ray);

// The point at t of a ray that hit there; the normal points outwards.
SurfacePoint point_at(const Sphere& sphere, const Ray& ray, double t);

} // namespace renderer
