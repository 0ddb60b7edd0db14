// The box of the part of a triangle that lies between two planes across an axis.
#pragma once

#include "renderer/math/bounds.h"

#include <limits>

namespace renderer {

// The floats on either side of a place; the place itself where it is one.
Vec3f round_down(Vec3d p);
Vec3f round_up(Vec3d p);

// Holds every point of the triangle whose coordinate along `axis` is within [from, to], both counted; empty where there
// is none. Corners finite, planes may be infinite.
Bounds3f part_between(const Vec3d (&corners)[3], unsigned axis, float from, float to);

} // namespace renderer
