#include "renderer/accel/instance.h"

#include "renderer/geometry/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace renderer {

namespace {

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

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

// |M| v + |t| and |M| v: how large the terms of a transform can be for |p| <= v.
Vec3d reach_of_vector(const Affine3& m, Vec3d v)
{
    return {dot(abs(m.rows[0]), v), dot(abs(m.rows[1]), v), dot(abs(m.rows[2]), v)};
}
Vec3d reach_of_point(const Affine3& m, Vec3d v)
{
    return reach_of_vector(m, v) + abs(m.translation);
}

// Centre and half extent of the shape in its own frame.
Bounds3d object_bounds(const InstanceGeometry& geometry)
{
    const auto in_double = [](const Bounds3f& box) {
        return Bounds3d{to_double(box.lower), to_double(box.upper)};
    };
    return std::visit(Overloaded{[&](const MeshGeometry& m) { return in_double(m.bvh->bounds()); },
                                 [&](const BaselineGeometry& m) { return in_double(m.search->bounds()); },
                                 [](const Sphere& s) {
                                     const Vec3d r = Vec3d{1, 1, 1} * s.radius;
                                     return Bounds3d{-r, r};
                                 },
                                 [](const Disk& d) {
                                     const Vec3d r{d.radius, d.radius, 0};
                                     return Bounds3d{-r, r};
                                 }},
                      geometry);
}

} // namespace

Instance::Instance(InstanceGeometry geometry,
                   const Affine3& world_from_object,
                   const Affine3& object_from_world,
                   bool visible_to_camera)
    : geometry_(geometry), world_from_object_(world_from_object), object_from_world_(object_from_world),
      trip_error_(error_of_round_trip(world_from_object, object_from_world)),
      identity_(world_from_object == Affine3{}), visible_to_camera_(visible_to_camera)
{
}

std::optional<Instance>
Instance::place(InstanceGeometry geometry, const Affine3& world_from_object, bool visible_to_camera)
{
    const std::optional<Affine3> inverse = world_from_object.inverse();
    if (!inverse) return std::nullopt;
    return Instance(geometry, world_from_object, *inverse, visible_to_camera);
}

// How far a world point within `world_reach` of the origin may be off after the trip to object space, told in
// the world; the inverse matrix is itself only as good as the forward one lets it be. With absolute values
// throughout, W to the world and O from it, that is gamma (W + W O W) O of the point: made once, with room for its own
// roundings.
Affine3 Instance::error_of_round_trip(const Affine3& world_from_object, const Affine3& object_from_world)
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

Vec3d Instance::round_trip_error(Vec3d world_reach) const
{
    return trip_error_.point(world_reach);
}

Bounds3d Instance::world_bounds() const
{
    const Bounds3d box = object_bounds(geometry_);
    if (box.empty() || identity_) return box;
    const Vec3d center = box.center(), half = box.upper * 0.5 - box.lower * 0.5;
    const Vec3d middle = world_from_object_.point(center);
    Vec3d extent = reach_of_vector(world_from_object_, half);
    const auto& rows = world_from_object_.rows;
    if (const Sphere* s = std::get_if<Sphere>(&geometry_))
        extent = Vec3d{length(rows[0]), length(rows[1]), length(rows[2])} * s->radius;
    const Vec3d reach = reach_of_point(world_from_object_, abs(center) + half);
    extent = extent + reach * gamma<double>(12) + round_trip_error(reach);
    return {middle - extent, middle + extent};
}

Ray Instance::to_object(const Ray& world_ray) const
{
    if (identity_) return world_ray;
    return {object_from_world_.point(world_ray.origin),
            object_from_world_.vector(world_ray.direction),
            world_ray.t_min,
            world_ray.t_max};
}

std::span<const Ray> Instance::to_object(std::span<const Ray> world_rays, Ray* room) const
{
    if (identity_) return world_rays;
    for (std::size_t i = 0; i < world_rays.size(); ++i)
        room[i] = to_object(world_rays[i]);
    return {room, world_rays.size()};
}

std::optional<Instance::Candidate> Instance::closest_hit(const Ray& world_ray) const
{
    const Ray ray = to_object(world_ray);
    const auto exact = [&](const auto& shape) -> std::optional<Candidate> {
        if (const std::optional<double> t = intersect(shape, ray)) return Candidate{*t, 0, {}};
        return std::nullopt;
    };
    return std::visit(Overloaded{[&](const MeshGeometry& m) { return m.bvh->closest_hit(ray); },
                                 [&](const BaselineGeometry& m) { return m.search->closest_hit(ray); },
                                 [&](const Sphere& s) { return exact(s); },
                                 [&](const Disk& d) { return exact(d); }},
                      geometry_);
}

bool Instance::any_hit(const Ray& world_ray) const
{
    const Ray ray = to_object(world_ray);
    return std::visit(Overloaded{[&](const MeshGeometry& m) { return m.bvh->any_hit(ray); },
                                 [&](const BaselineGeometry& m) { return m.search->any_hit(ray); },
                                 [&](const Sphere& s) { return intersect(s, ray).has_value(); },
                                 [&](const Disk& d) { return intersect(d, ray).has_value(); }},
                      geometry_);
}

std::uint64_t Instance::closest_hits(std::span<const Ray> world_rays, Candidate* hits) const
{
    if (const auto* mesh = std::get_if<MeshGeometry>(&geometry_)) {
        Ray rays[kMostRays];
        return mesh->bvh->closest_hits(to_object(world_rays, rays), {hits, world_rays.size()});
    }
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < world_rays.size(); ++i)
        if (const std::optional<Candidate> hit = closest_hit(world_rays[i])) {
            hits[i] = *hit;
            found |= std::uint64_t{1} << i;
        }
    return found;
}

std::uint64_t Instance::any_hits(std::span<const Ray> world_rays) const
{
    std::uint64_t found = 0;
    if (const auto* mesh = std::get_if<MeshGeometry>(&geometry_)) {
        Ray rays[kMostRays];
        return mesh->bvh->any_hits(to_object(world_rays, rays));
    }
    for (std::size_t i = 0; i < world_rays.size(); ++i)
        if (any_hit(world_rays[i])) found |= std::uint64_t{1} << i;
    return found;
}

SurfacePoint Instance::to_world(const SurfacePoint& object_point) const
{
    if (identity_) return object_point;
    SurfacePoint world;
    world.position = world_from_object_.point(object_point.position);
    // The point's own error, and the roundings of this transform.
    const Vec3d error = object_point.error + abs(object_point.position) * gamma<double>(5);
    world.error = reach_of_vector(world_from_object_, error) +
                  abs(world_from_object_.translation) * gamma<double>(5) +
                  round_trip_error(abs(world.position));
    world.normal = normalize(object_from_world_.transposed_vector(object_point.normal));
    return world;
}

SceneHit Instance::resolve(const Ray& world_ray, const Candidate& candidate) const
{
    const auto exact = [&](const auto& shape) { return point_at(shape, to_object(world_ray), candidate.t); };
    const auto on_mesh = [&](const Mesh& mesh) { return surface_point(mesh, candidate); };
    const SurfacePoint object =
        std::visit(Overloaded{[&](const MeshGeometry& m) { return on_mesh(*m.mesh); },
                              [&](const BaselineGeometry& m) { return on_mesh(*m.mesh); },
                              [&](const Sphere& s) { return exact(s); },
                              [&](const Disk& d) { return exact(d); }},
                   geometry_);
    SceneHit hit;
    hit.t = candidate.t;
    hit.primitive = candidate.primitive;
    hit.barycentrics = candidate.barycentrics;
    hit.object_position = object.position;
    hit.point = to_world(object);
    return hit;
}

} // namespace renderer
