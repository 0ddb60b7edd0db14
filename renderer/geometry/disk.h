// Disk: in the xy plane, centred at the origin, facing +z; scenes place it by a transform.
#pragma once

#include "renderer/geometry/ray.h"
#include "renderer/geometry/surface_point.h"

#include <optional>

namespace renderer {

struct Disk {
    double radius;
};

// t of the hit within the ray's range, from either side. A ray in the disk's plane misses.
std::optional<double> intersect(const Disk& disk, const Ray& ray);

// The point at t of a ray that hit there; the normal is +z.
SurfacePoint point_at(const Disk& disk, const Ray& ray, double t);

} // namespace renderer
