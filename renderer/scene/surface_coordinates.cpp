#include "renderer/scene/surface_coordinates.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace renderer {

namespace {

using Found = std::optional<SurfaceCoordinates>;

// The gradients follow from how far u and v change along two edges: those along the edges' dual vectors.
Found on_triangle(const SceneHit& hit, const Mesh& mesh, const Affine3& world_from_object)
{
    if (mesh.uvs.empty()) return std::nullopt;
    const Triangle& triangle = mesh.triangles[hit.primitive];
    const auto corner = [&](std::size_t i) { return world_from_object.point(mesh.position(triangle[i])); };
    const auto uv = [&](std::size_t i) -> TexturePoint {
        const Vec2f at = mesh.uvs[triangle[i]];
        return {static_cast<double>(at.x), static_cast<double>(at.y)};
    };
    const TexturePoint a = uv(0), b = uv(1), c = uv(2);
    const Vec3d w = hit.barycentrics;
    SurfaceCoordinates out{{a.u * w.x + b.u * w.y + c.u * w.z, a.v * w.x + b.v * w.y + c.v * w.z}, {}, {}};
    const Vec3d origin = corner(0), e1 = corner(1) - origin, e2 = corner(2) - origin, n = cross(e1, e2);
    const double area = dot(n, n);
    if (!(area > 0)) return out;
    const Vec3d dual1 = cross(e2, n) / area, dual2 = cross(n, e1) / area;
    out.u_gradient = dual1 * (b.u - a.u) + dual2 * (c.u - a.u);
    out.v_gradient = dual1 * (b.v - a.v) + dual2 * (c.v - a.v);
    return out;
}

Found on_sphere(Vec3d p, const Sphere& sphere, const Affine3& object_from_world)
{
    const double radius = length(p);
    if (!(radius > 0)) return SurfaceCoordinates{};
    const double height = std::clamp(p.y / radius, -1.0, 1.0), across = p.x * p.x + p.z * p.z;
    SurfaceCoordinates out{{0.5 + atan2(p.x, p.z) / (2 * kPi), 1 - acos(height) / kPi}, {}, {}};
    if (!(across > 0)) return out;
    const Vec3d along_u = Vec3d{p.z, 0, -p.x} / (across * 2 * kPi);
    const double ring = std::sqrt(across);
    const Vec3d north = Vec3d{-p.x * p.y / ring, ring, -p.z * p.y / ring} / radius;
    out.u_gradient = object_from_world.transposed_vector(along_u);
    out.v_gradient = object_from_world.transposed_vector(north / (kPi * sphere.radius));
    return out;
}

Found on_disk(Vec3d p, const Disk& disk, const Affine3& object_from_world)
{
    const double across = 2 * disk.radius;
    return SurfaceCoordinates{{0.5 + p.x / across, 0.5 + p.y / across},
                              object_from_world.transposed_vector({1 / across, 0, 0}),
                              object_from_world.transposed_vector({0, 1 / across, 0})};
}

bool is_usable(Vec3d v)
{
    return is_finite(v) && max_component(abs(v)) > 0;
}

} // namespace

std::optional<SurfaceCoordinates> coordinates_at(const SceneHit& hit, const Instance& instance)
{
    const InstanceGeometry& geometry = instance.geometry();
    if (const auto* const mesh = std::get_if<MeshGeometry>(&geometry))
        return on_triangle(hit, *mesh->mesh, instance.world_from_object());
    if (const auto* const mesh = std::get_if<BaselineGeometry>(&geometry))
        return on_triangle(hit, *mesh->mesh, instance.world_from_object());
    if (const auto* const sphere = std::get_if<Sphere>(&geometry))
        return on_sphere(hit.object_position, *sphere, instance.object_from_world());
    return on_disk(hit.object_position, std::get<Disk>(geometry), instance.object_from_world());
}

TextureFootprint footprint_of(const SurfaceCoordinates& at, Vec3d normal, Vec3d toward_viewer, double width)
{
    if (!(width > 0)) return {};
    const double cosine = std::max(std::abs(dot(normal, toward_viewer)), 1e-3);
    const Vec3d lying = toward_viewer - normal * dot(normal, toward_viewer);
    const double slant = length(lying);
    // Seen head on the ellipse is a circle: any axis will do.
    const Vec3d across = std::abs(normal.x) > 0.5 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d along = slant > 1e-6 ? lying / slant : normalize(across - normal * dot(across, normal));
    const Vec3d longer = along * (width / cosine), shorter = cross(normal, along) * width;
    return {{dot(at.u_gradient, longer), dot(at.v_gradient, longer)},
            {dot(at.u_gradient, shorter), dot(at.v_gradient, shorter)}};
}

Vec3d tilted_normal(const SurfaceCoordinates& at, Vec3d normal, Vec3d tilt)
{
    // The way of growing u is at right angles to v's gradient, and the other way about.
    const Vec3d flat_v = at.v_gradient - normal * dot(at.v_gradient, normal);
    Vec3d tangent = cross(flat_v, normal);
    if (!is_usable(tangent) || !is_usable(at.u_gradient)) return normal;
    tangent = normalize(tangent);
    if (dot(tangent, at.u_gradient) < 0) tangent = -tangent;
    Vec3d bitangent = cross(normal, tangent);
    if (dot(bitangent, at.v_gradient) < 0) bitangent = -bitangent;
    const Vec3d turned = tangent * tilt.x + bitangent * tilt.y + normal * tilt.z;
    return is_usable(turned) ? normalize(turned) : normal;
}

} // namespace renderer
