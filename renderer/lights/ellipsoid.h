// EllipsoidPoint: a place of an emitter that is a sphere whose half axes were stretched and turned.
#pragma once

#include "renderer/lights/emitter.h"
#include "renderer/math/transcendental.h"

namespace renderer {

// Half axes as the columns of a map from the unit sphere: where its normal goes, and what area it has there.
struct EllipsoidPoint {
    Vec3d normal;    // unit, outward
    double per_area; // density of a direction drawn uniformly in the unit sphere
};

inline EllipsoidPoint ellipsoid_point(const Emitter& e, Vec3d on_unit)
{
    const Vec3d cofactors = cross(e.side_v, e.side_w) * on_unit.x + cross(e.side_w, e.side_u) * on_unit.y +
                            cross(e.side_u, e.side_v) * on_unit.z;
    const double determinant = dot(e.side_u, cross(e.side_v, e.side_w)), stretch = length(cofactors);
    const Vec3d normal = cofactors / (determinant < 0 ? -stretch : stretch);
    return {normal, 1 / (4 * kPi * stretch)};
}

} // namespace renderer
