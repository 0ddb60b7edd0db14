// Placement: where an object stands in the world, and what the trip between the two frames costs in roundings.
#pragma once

#include "renderer/geometry/ray.h"
#include "renderer/geometry/surface_point.h"
#include "renderer/math/affine.h"

#include <optional>

namespace renderer {

struct Placement {
    Affine3 world_from_object, object_from_world;
    // Makes of |p|, for a world point p, how far it may be off after the trip to object space, told in the world.
    Affine3 trip_error;
    bool is_identity = true;

    // Nothing if `world_from_object` is singular.
    static std::optional<Placement> at(const Affine3& world_from_object);

    Ray to_object(const Ray& world_ray) const
    {
        if (is_identity) return world_ray;
        return {object_from_world.point(world_ray.origin),
                object_from_world.vector(world_ray.direction),
                world_ray.t_min,
                world_ray.t_max};
    }
    SurfacePoint to_world(const SurfacePoint& object_point) const;
};

// |M| v and |M| v + |t|: how large the terms of a transform can be for |p| <= v.
Vec3d reach_of_vector(const Affine3& m, Vec3d v);
Vec3d reach_of_point(const Affine3& m, Vec3d v);

// Roundings of an object point's trip to the world.
inline constexpr int kPlacingRoundings = 5;

} // namespace renderer
