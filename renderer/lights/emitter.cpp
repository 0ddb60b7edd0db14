#include "renderer/lights/emitter.h"

#include "renderer/color/strongest.h"
#include "renderer/lights/ellipsoid.h"
#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

constexpr double kRightAngle = 1e-9; // cosine up to which sides count as at right angles

Vec3d column(const Affine3& m, std::size_t i)
{
    return {m.rows[0][i], m.rows[1][i], m.rows[2][i]};
}

std::optional<Emitter> with_area(const Emitter& e)
{
    if (!(e.area > 0) || !std::isfinite(e.area)) return std::nullopt;
    return e;
}

Emitter flat(EmitterShape shape, Vec3d corner, Vec3d side_u, Vec3d side_v, Rgb radiance, bool two_sided)
{
    Emitter e;
    e.shape = shape;
    e.two_sided = two_sided;
    e.corner = corner;
    e.side_u = side_u;
    e.side_v = side_v;
    e.radiance = radiance;
    e.area = length(cross(side_u, side_v));
    if (e.area > 0) e.normal = normalize(cross(side_u, side_v));
    return e;
}

double shining_area(const Emitter& e)
{
    return e.two_sided ? 2 * e.area : e.area;
}

// By the middles of equal shares of the unit sphere: what is left is below 1e-6 for axes up to ten times apart.
double ellipsoid_area(const Emitter& e)
{
    constexpr int kRings = 256, kTurns = 256;
    double sum = 0;
    for (int i = 0; i < kRings; ++i) {
        const double z = (2 * i + 1.0) / kRings - 1, r = std::sqrt(1 - z * z);
        for (int j = 0; j < kTurns; ++j) {
            const auto [s, c] = sin_cos(2 * kPi * (j + 0.5) / kTurns);
            sum += 1 / ellipsoid_point(e, {r * c, r * s, z}).per_area;
        }
    }
    return sum / (kRings * kTurns);
}

} // namespace

std::optional<Emitter> triangle_emitter(Vec3d a, Vec3d b, Vec3d c, Rgb radiance, bool two_sided)
{
    Emitter e = flat(EmitterShape::triangle, a, b - a, c - a, radiance, two_sided);
    e.area /= 2;
    return with_area(e);
}

std::optional<Emitter> rectangle_emitter(const Affine3& world_from_unit, Rgb radiance, bool two_sided)
{
    const Vec3d u = column(world_from_unit, 0), v = column(world_from_unit, 1);
    Emitter e = flat(EmitterShape::parallelogram,
                     world_from_unit.translation - u / 2.0 - v / 2.0,
                     u,
                     v,
                     radiance,
                     two_sided);
    e.is_rectangle = std::abs(dot(u, v)) <= kRightAngle * length(u) * length(v);
    if (e.is_rectangle) e.side_w = normalize(u);
    if (dot(e.normal, column(world_from_unit, 2)) < 0)
        e.normal = -e.normal; // mirrored: +z shines all the same
    return with_area(e);
}

std::optional<Emitter>
disk_emitter(const Affine3& world_from_disk, double radius, Rgb radiance, bool two_sided)
{
    Emitter e = flat(EmitterShape::disk,
                     world_from_disk.translation,
                     column(world_from_disk, 0) * radius,
                     column(world_from_disk, 1) * radius,
                     radiance,
                     two_sided);
    e.area *= kPi;
    if (dot(e.normal, column(world_from_disk, 2)) < 0) e.normal = -e.normal;
    return with_area(e);
}

std::optional<Emitter>
sphere_emitter(const Affine3& world_from_sphere, double radius, Rgb radiance, bool two_sided)
{
    Emitter e;
    e.two_sided = two_sided;
    e.corner = world_from_sphere.translation;
    e.side_u = column(world_from_sphere, 0) * radius;
    e.side_v = column(world_from_sphere, 1) * radius;
    e.side_w = column(world_from_sphere, 2) * radius;
    e.radiance = radiance;
    const double a = length(e.side_u), b = length(e.side_v), c = length(e.side_w),
                 tolerance = kRightAngle * a;
    const bool round = std::abs(a - b) <= tolerance && std::abs(a - c) <= tolerance &&
                       std::abs(dot(e.side_u, e.side_v)) <= tolerance * a &&
                       std::abs(dot(e.side_u, e.side_w)) <= tolerance * a &&
                       std::abs(dot(e.side_v, e.side_w)) <= tolerance * a;
    e.shape = round ? EmitterShape::sphere : EmitterShape::ellipsoid;
    e.radius = a;
    e.area = round ? 4 * kPi * a * a : ellipsoid_area(e);
    return with_area(e);
}

Bounds3d bounds_of(const Emitter& e)
{
    Bounds3d box;
    switch (e.shape) {
    case EmitterShape::triangle:
        for (const Vec3d& p : {e.corner, e.corner + e.side_u, e.corner + e.side_v})
            box.extend(p);
        return box;
    case EmitterShape::parallelogram:
        for (const Vec3d& p :
             {e.corner, e.corner + e.side_u, e.corner + e.side_v, e.corner + e.side_u + e.side_v})
            box.extend(p);
        return box;
    case EmitterShape::disk:
    case EmitterShape::sphere:
    case EmitterShape::ellipsoid: {
        const auto reach = [&](std::size_t i) {
            return std::sqrt(e.side_u[i] * e.side_u[i] + e.side_v[i] * e.side_v[i] +
                             e.side_w[i] * e.side_w[i]);
        };
        const Vec3d half{reach(0), reach(1), reach(2)};
        box.extend(e.corner - half);
        box.extend(e.corner + half);
        return box;
    }
    }
    return box;
}

double power_of(const Emitter& e)
{
    return static_cast<double>(strongest(e.radiance)) * kPi * shining_area(e);
}

Rgb radiance_of_power(Rgb power, const Emitter& e)
{
    const double share = 1 / (kPi * shining_area(e));
    const auto radiance = [share](float watt) {
        return static_cast<float>(static_cast<double>(watt) * share);
    };
    return {radiance(power.r), radiance(power.g), radiance(power.b)};
}

} // namespace renderer
