// SurfacePoint: where a ray met a surface, how far off that can be, and how to leave from there.
//
// Frame   whatever the maker says: object space in geometry, world space in a SceneHit.
// Source  M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd ed., section 3.9: the bound is
//         carried with the point; no constant bias. We need far less room than it does, since points and t
//         are in double.
#pragma once

#include "renderer/math/vec3.h"

namespace renderer {

struct SurfacePoint {
    Vec3d position;
    Vec3d error;  // the true surface is within these distances along x, y and z, the trip of the next ray
                  // included
    Vec3d normal; // geometric, unit, on the side the winding or the shape says is outside
};

// Where a ray that leaves towards `direction` starts: on that side of the surface for certain, and no farther
// away than rounding asks. `direction` may point to either side (reflection or transmission).
Vec3d offset_origin(const SurfacePoint& from, Vec3d direction);

// Corner form: the point of triangle a, b, c with the given weights (any winding; the normal is along (b-a) x
// (c-a)).
SurfacePoint triangle_point(Vec3d a, Vec3d b, Vec3d c, Vec3d barycentrics);
// The same without its normal, for those who know it.
SurfacePoint weighted_point(Vec3d a, Vec3d b, Vec3d c, Vec3d barycentrics);

// Products and sums round; the weights themselves may miss a sum of 1 by four roundings.
inline constexpr int kWeighingRoundings = 8;

} // namespace renderer
