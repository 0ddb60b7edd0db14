#include "renderer/accel/instance.h"

#include "renderer/accel/surface_kernels.h"
#include "renderer/geometry/rounding.h"
#include "renderer/math/uninitialized.h"

#include <bit>
#include <cstddef>

namespace renderer {

namespace {

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

void put(SurfaceLanes::Vectors& to, std::size_t lane, Vec3d v)
{
    to[0][lane] = v.x;
    to[1][lane] = v.y;
    to[2][lane] = v.z;
}
Vec3d at(const SurfaceLanes::Vectors& from, std::size_t lane)
{
    return {from[0][lane], from[1][lane], from[2][lane]};
}

void put(const Mesh& mesh, const MeshHit& hit, SurfaceLanes& lanes, std::size_t lane)
{
    const Triangle& v = mesh.triangles[hit.primitive];
    for (std::size_t k = 0; k < 3; ++k)
        put(lanes.corner[k], lane, mesh.position(v[k]));
    put(lanes.weights, lane, hit.barycentrics);
}

void take(const MeshHit& hit, const SurfaceLanes& lanes, std::size_t lane, SceneHit& to)
{
    to.t = hit.t;
    to.primitive = hit.primitive;
    to.barycentrics = hit.barycentrics;
    to.object_position = at(lanes.object_position, lane);
    to.point = {at(lanes.position, lane), at(lanes.error, lane), at(lanes.normal, lane)};
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

const Mesh* mesh_behind(const InstanceGeometry& geometry)
{
    if (const auto* wide = std::get_if<MeshGeometry>(&geometry)) return wide->mesh;
    const auto* const baseline = std::get_if<BaselineGeometry>(&geometry);
    return baseline != nullptr ? baseline->mesh : nullptr;
}

Instance::Instance(InstanceGeometry geometry, const Placement& placement, bool visible_to_camera)
    : geometry_(geometry), placement_(placement), visible_to_camera_(visible_to_camera)
{
}

std::optional<Instance>
Instance::place(InstanceGeometry geometry, const Affine3& world_from_object, bool visible_to_camera)
{
    const std::optional<Placement> placement = Placement::at(world_from_object);
    if (!placement) return std::nullopt;
    return Instance(geometry, *placement, visible_to_camera);
}

Bounds3d Instance::world_bounds() const
{
    const Bounds3d box = object_bounds(geometry_);
    if (box.empty() || placement_.is_identity) return box;
    const Vec3d center = box.center(), half = box.upper * 0.5 - box.lower * 0.5;
    const Affine3& there = placement_.world_from_object;
    const Vec3d middle = there.point(center);
    Vec3d extent = reach_of_vector(there, half);
    const auto& rows = there.rows;
    if (const Sphere* s = std::get_if<Sphere>(&geometry_))
        extent = Vec3d{length(rows[0]), length(rows[1]), length(rows[2])} * s->radius;
    const Vec3d reach = reach_of_point(there, abs(center) + half);
    extent = extent + reach * gamma<double>(12) + placement_.trip_error.point(reach);
    return {middle - extent, middle + extent};
}

std::span<const Ray> Instance::to_object(std::span<const Ray> world_rays, Ray* room) const
{
    if (placement_.is_identity) return world_rays;
    for (std::size_t i = 0; i < world_rays.size(); ++i)
        room[i] = placement_.to_object(world_rays[i]);
    return {room, world_rays.size()};
}

std::optional<Instance::Candidate> Instance::closest_hit(const Ray& world_ray) const
{
    const Ray ray = placement_.to_object(world_ray);
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
    const Ray ray = placement_.to_object(world_ray);
    return std::visit(Overloaded{[&](const MeshGeometry& m) { return m.bvh->any_hit(ray); },
                                 [&](const BaselineGeometry& m) { return m.search->any_hit(ray); },
                                 [&](const Sphere& s) { return intersect(s, ray).has_value(); },
                                 [&](const Disk& d) { return intersect(d, ray).has_value(); }},
                      geometry_);
}

std::uint64_t Instance::closest_hits(std::span<const Ray> world_rays, Candidate* hits) const
{
    if (const auto* mesh = std::get_if<MeshGeometry>(&geometry_)) {
        Uninitialized<Ray, kMostRays> rays;
        return mesh->bvh->closest_hits(to_object(world_rays, rays.data()), {hits, world_rays.size()});
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
        Uninitialized<Ray, kMostRays> rays;
        return mesh->bvh->any_hits(to_object(world_rays, rays.data()));
    }
    for (std::size_t i = 0; i < world_rays.size(); ++i)
        if (any_hit(world_rays[i])) found |= std::uint64_t{1} << i;
    return found;
}

SceneHit Instance::resolve(const Ray& world_ray, const Candidate& candidate) const
{
    const auto exact = [&](const auto& shape) {
        return point_at(shape, placement_.to_object(world_ray), candidate.t);
    };
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
    hit.point = placement_.to_world(object);
    return hit;
}

void Instance::resolve(std::span<const Ray> world_rays,
                       const Candidate* candidates,
                       std::uint64_t which,
                       SceneHit* hits) const
{
    const Mesh* const mesh = mesh_behind(geometry_);
    SurfaceLanes lanes;
    std::size_t of[SurfaceLanes::kHits];
    while (mesh != nullptr && which != 0) {
        std::size_t count = 0;
        for (; which != 0 && count < SurfaceLanes::kHits; which &= which - 1, ++count) {
            of[count] = static_cast<std::size_t>(std::countr_zero(which));
            put(*mesh, candidates[of[count]], lanes, count);
        }
        for (std::size_t lane = count; lane < SurfaceLanes::kHits; ++lane)
            put(*mesh, candidates[of[0]], lanes, lane);
        find_surfaces()(placement_, lanes);
        for (std::size_t lane = 0; lane < count; ++lane)
            take(candidates[of[lane]], lanes, lane, hits[of[lane]]);
    }
    for (; which != 0; which &= which - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(which));
        hits[i] = resolve(world_rays[i], candidates[i]);
    }
}

} // namespace renderer
