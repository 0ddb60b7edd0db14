#include "renderer/accel/placement.h"

#include "renderer/geometry/rounding.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace renderer {

namespace {

Affine3 absolute(const Affine3& m)
{
    return {{abs(m.rows[0]), abs(m.rows[1]), abs(m.rows[2])}, abs(m.translation)};
}

// Of terms that are not negative: what has overflowed would be no number times zero.
Affine3 at_most_finite(Affine3 m)
{
    const auto bounded = [](Vec3d v) {
        constexpr double kMost = std::numeric_limits<double>::max();
        return Vec3d{std::min(v.x, kMost), std::min(v.y, kMost), std::min(v.z, kMost)};
    };
    for (Vec3d& row : m.rows)
        row = bounded(row);
    m.translation = bounded(m.translation);
    return m;
}

// The inverse matrix is itself only as good as the forward one lets it be. With absolute values throughout, W to the
// world and O from it, the error is gamma (W + W O W) O of the point: made once, with room for its own roundings.
Affine3 error_of_round_trip(const Affine3& world_from_object, const Affine3& object_from_world)
{
    const Affine3 there = absolute(world_from_object), back = absolute(object_from_world);
    const Affine3 linear_there{there.rows, {}}, linear_back{back.rows, {}};
    const Affine3 once = at_most_finite(linear_there * back);
    const Affine3 again = at_most_finite(linear_there * at_most_finite(linear_back * once));
    Affine3 sum;
    for (std::size_t i = 0; i < 3; ++i)
        sum.rows[i] = (once.rows[i] + again.rows[i]) * gamma<double>(13);
    sum.translation = (once.translation + again.translation) * gamma<double>(13);
    return at_most_finite(sum);
}

} // namespace

Vec3d reach_of_vector(const Affine3& m, Vec3d v)
{
    return {dot(abs(m.rows[0]), v), dot(abs(m.rows[1]), v), dot(abs(m.rows[2]), v)};
}
Vec3d reach_of_point(const Affine3& m, Vec3d v)
{
    return reach_of_vector(m, v) + abs(m.translation);
}

std::optional<Placement> Placement::at(const Affine3& world_from_object)
{
    const std::optional<Affine3> inverse = world_from_object.inverse();
    if (!inverse) return std::nullopt;
    return Placement{world_from_object,
                     *inverse,
                     error_of_round_trip(world_from_object, *inverse),
                     world_from_object == Affine3{}};
}

SurfacePoint Placement::to_world(const SurfacePoint& object_point) const
{
    if (is_identity) return object_point;
    SurfacePoint world;
    world.position = world_from_object.point(object_point.position);
    // The point's own error, and the roundings of this transform.
    constexpr double kPlacing = gamma<double>(kPlacingRoundings);
    const Vec3d error = object_point.error + abs(object_point.position) * kPlacing;
    world.error = reach_of_vector(world_from_object, error) + abs(world_from_object.translation) * kPlacing +
                  trip_error.point(abs(world.position));
    world.normal = normalize(object_from_world.transposed_vector(object_point.normal));
    return world;
}

} // namespace renderer
