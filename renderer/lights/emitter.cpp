#include "renderer/lights/emitter.h"

#include "renderer/color/strongest.h"
#include "renderer/lights/rectangle_kernels.h"
#include "renderer/lights/spherical_sampling.h"
#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

// Seen under less, a flat emitter is as good as a small one: area sampling has little noise there, and the sums of
// angles would have few digits. Above the other one the triangle's formulas lose theirs.
constexpr double kLeastSolidAngle = 1e-3, kMostSolidAngle = 6.2;
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

bool sees_it_shine(const Emitter& e, Vec3d point)
{
    const double height = dot(point - e.corner, e.normal);
    return e.two_sided ? height != 0 : height > 0;
}

EmitterSample at(Vec3d point, Vec3d on_emitter, double pdf)
{
    const Vec3d way = on_emitter - point;
    const double distance = length(way);
    if (!(distance > 0) || !(pdf > 0) || !std::isfinite(pdf)) return {};
    return {way / distance, distance, pdf};
}

// Density per solid angle of a point that was drawn with `per_area`.
double over_solid_angle(double per_area, Vec3d point, Vec3d on_emitter, Vec3d normal)
{
    const Vec3d way = on_emitter - point;
    const double distance = length(way);
    const double cosine = std::abs(dot(way / distance, normal));
    return distance > 0 && cosine > 0 ? per_area * distance * distance / cosine : 0;
}

EmitterSample at_by_area(Vec3d point, Vec3d on_emitter, Vec3d normal, double per_area)
{
    return at(point, on_emitter, over_solid_angle(per_area, point, on_emitter, normal));
}

SphericalTriangle triangle_seen(const Emitter& e, Vec3d point)
{
    return {e.corner - point, e.corner + e.side_u - point, e.corner + e.side_v - point};
}

bool by_solid_angle(const SphericalTriangle& seen)
{
    return seen.solid_angle() > kLeastSolidAngle && seen.solid_angle() < kMostSolidAngle;
}

EmitterSample sample_triangle(const Emitter& e, Vec3d point, Sample2 u)
{
    if (const SphericalTriangle seen = triangle_seen(e, point); by_solid_angle(seen)) {
        const Vec3d wi = seen.sample(u);
        const double distance = dot(e.corner - point, e.normal) / dot(wi, e.normal);
        if (!(distance > 0) || !std::isfinite(distance)) return {};
        return {wi, distance, 1 / seen.solid_angle()};
    }
    // Uniform over the area: E. Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
    double b0 = static_cast<double>(u.u0) / 2, b1 = static_cast<double>(u.u1) / 2;
    const double apart = b1 - b0;
    (apart > 0 ? b1 : b0) += std::abs(apart);
    return at_by_area(point, e.corner + e.side_u * b0 + e.side_v * b1, e.normal, 1 / e.area);
}

RectangleView as_rectangle(const Emitter& e)
{
    const Vec3d across = cross(e.normal, e.side_w);
    const double height = dot(e.side_v, across);
    return {.corner = e.corner,
            .x = e.side_w,
            .y = height < 0 ? -across : across, // mirrored, or not
            .z = e.normal,
            .width = dot(e.side_u, e.side_w),
            .height = std::abs(height)};
}

SphericalRectangle rectangle_seen(const Emitter& e, Vec3d point)
{
    const RectangleView r = as_rectangle(e);
    return {r.corner - point, {.x = r.x, .y = r.y, .z = r.z}, r.width, r.height};
}

EmitterSample sample_parallelogram(const Emitter& e, Vec3d point, Sample2 u)
{
    if (e.is_rectangle) {
        const SphericalRectangle seen = rectangle_seen(e, point);
        if (seen.solid_angle() > kLeastSolidAngle)
            return at(point, point + seen.sample(u), 1 / seen.solid_angle());
    }
    const Vec3d drawn =
        e.corner + e.side_u * static_cast<double>(u.u0) + e.side_v * static_cast<double>(u.u1);
    return at_by_area(point, drawn, e.normal, 1 / e.area);
}

EmitterSample sample_disk(const Emitter& e, Vec3d point, Sample2 u)
{
    const auto [x, y] = concentric_disk(u);
    return at_by_area(point, e.corner + e.side_u * x + e.side_v * y, e.normal, 1 / e.area);
}

// The cone of directions that meet a sphere, by the sine of half its opening.
struct Cone {
    Vec3d axis;
    double distance;         // to the centre
    double one_minus_cosine; // of half the opening
};

std::optional<Cone> cone_of(const Emitter& e, Vec3d point)
{
    const Vec3d way = e.corner - point;
    const double distance = length(way), sine = e.radius / distance;
    if (!(sine < 1)) return std::nullopt; // inside
    return Cone{way / distance, distance, sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)))};
}

Vec3d on_unit_sphere(Sample2 u)
{
    const double z = 1 - 2 * static_cast<double>(u.u0),
                 r = 2 * std::sqrt(static_cast<double>(u.u0) * (1 - static_cast<double>(u.u0)));
    const auto [s, c] = sin_cos(2 * kPi * static_cast<double>(u.u1));
    return {r * c, r * s, z};
}

EmitterSample sample_sphere(const Emitter& e, Vec3d point, Sample2 u)
{
    const auto cone = cone_of(e, point);
    if (!cone) { // from inside only a two-sided one is seen to shine, and all of it
        if (!e.two_sided) return {};
        const Vec3d n = on_unit_sphere(u);
        return at_by_area(point, e.corner + n * e.radius, n, 1 / e.area);
    }
    const double off = static_cast<double>(u.u0) * cone->one_minus_cosine; // 1 - cosine from the axis
    const double sine2 = off * (2 - off), cosine = 1 - off;
    const auto [s, c] = sin_cos(2 * kPi * static_cast<double>(u.u1));
    const auto [x, y] = basis_around(cone->axis);
    const Vec3d wi = normalize(cone->axis * cosine + (x * c + y * s) * std::sqrt(sine2));
    const double half_chord2 = e.radius * e.radius - cone->distance * cone->distance * sine2;
    const double distance = cone->distance * cosine - std::sqrt(std::max(0.0, half_chord2));
    if (!(distance > 0)) return {};
    return {wi, distance, 1 / (2 * kPi * cone->one_minus_cosine)};
}

// Half axes as the columns of a map from the unit sphere: where its normal goes, and what area it has there.
struct EllipsoidPoint {
    Vec3d normal;    // unit, outward
    double per_area; // density of a direction drawn uniformly in the unit sphere
};

EllipsoidPoint ellipsoid_point(const Emitter& e, Vec3d on_unit)
{
    const Vec3d cofactors = cross(e.side_v, e.side_w) * on_unit.x + cross(e.side_w, e.side_u) * on_unit.y +
                            cross(e.side_u, e.side_v) * on_unit.z;
    const double determinant = dot(e.side_u, cross(e.side_v, e.side_w)), stretch = length(cofactors);
    const Vec3d normal = cofactors / (determinant < 0 ? -stretch : stretch);
    return {normal, 1 / (4 * kPi * stretch)};
}

EmitterSample sample_ellipsoid(const Emitter& e, Vec3d point, Sample2 u)
{
    const Vec3d s = on_unit_sphere(u);
    const Vec3d p = e.corner + e.side_u * s.x + e.side_v * s.y + e.side_w * s.z;
    const EllipsoidPoint drawn = ellipsoid_point(e, s);
    if (!e.two_sided && !(dot(point - p, drawn.normal) > 0)) return {};
    return at_by_area(point, p, drawn.normal, drawn.per_area);
}

double pdf_ellipsoid(const Emitter& e, Vec3d point, Vec3d hit)
{
    const double determinant = dot(e.side_u, cross(e.side_v, e.side_w));
    const Vec3d from_centre = hit - e.corner;
    const Vec3d s = Vec3d{dot(cross(e.side_v, e.side_w), from_centre),
                          dot(cross(e.side_w, e.side_u), from_centre),
                          dot(cross(e.side_u, e.side_v), from_centre)} /
                    determinant;
    const EllipsoidPoint there = ellipsoid_point(e, s);
    return over_solid_angle(there.per_area, point, hit, there.normal);
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

EmitterSample sample(const Emitter& e, Vec3d point, Sample2 u)
{
    switch (e.shape) {
    case EmitterShape::triangle:
        return sees_it_shine(e, point) ? sample_triangle(e, point, u) : EmitterSample{};
    case EmitterShape::parallelogram:
        return sees_it_shine(e, point) ? sample_parallelogram(e, point, u) : EmitterSample{};
    case EmitterShape::disk:
        return sees_it_shine(e, point) ? sample_disk(e, point, u) : EmitterSample{};
    case EmitterShape::sphere:
        return sample_sphere(e, point, u);
    case EmitterShape::ellipsoid:
        return sample_ellipsoid(e, point, u);
    }
    return {};
}

namespace {

void sample_rectangle(const Emitter& e,
                      std::span<const Vec3d> points,
                      std::span<const Sample2> u,
                      std::span<EmitterSample> out)
{
    RectangleRun run;
    // Lanes behind the last point are drawn as well.
    for (std::size_t i = 0; i < RectangleRun::kPoints && i < points.size() + RectangleRun::kMostLanes; ++i) {
        const std::size_t at = std::min(i, points.size() - 1);
        for (std::size_t axis = 0; axis < 3; ++axis)
            run.point[axis][i] = points[at][axis];
        run.u0[i] = static_cast<double>(u[at].u0);
        run.u1[i] = static_cast<double>(u[at].u1);
    }
    draw_on_rectangle()(as_rectangle(e), run, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double solid_angle = run.solid_angle[i], distance = run.distance[i];
        if (!(solid_angle > kLeastSolidAngle) || !sees_it_shine(e, points[i]))
            out[i] = sample(e, points[i], u[i]);
        else if (distance > 0)
            out[i] = {
                {run.direction[0][i], run.direction[1][i], run.direction[2][i]}, distance, 1 / solid_angle};
        else
            out[i] = {};
    }
}

} // namespace

void sample_many(const Emitter& emitter,
                 std::span<const Vec3d> points,
                 std::span<const Sample2> u,
                 std::span<EmitterSample> out)
{
    if (!emitter.is_rectangle) {
        for (std::size_t i = 0; i < points.size(); ++i)
            out[i] = sample(emitter, points[i], u[i]);
        return;
    }
    for (std::size_t first = 0; first < points.size(); first += RectangleRun::kPoints) {
        const std::size_t count = std::min(RectangleRun::kPoints, points.size() - first);
        sample_rectangle(
            emitter, points.subspan(first, count), u.subspan(first, count), out.subspan(first, count));
    }
}

double pdf(const Emitter& e, Vec3d point, Vec3d hit)
{
    switch (e.shape) {
    case EmitterShape::triangle: {
        if (!sees_it_shine(e, point)) return 0;
        const SphericalTriangle seen = triangle_seen(e, point);
        return by_solid_angle(seen) ? 1 / seen.solid_angle()
                                    : over_solid_angle(1 / e.area, point, hit, e.normal);
    }
    case EmitterShape::parallelogram: {
        if (!sees_it_shine(e, point)) return 0;
        if (e.is_rectangle) {
            const SphericalRectangle seen = rectangle_seen(e, point);
            if (seen.solid_angle() > kLeastSolidAngle) return 1 / seen.solid_angle();
        }
        return over_solid_angle(1 / e.area, point, hit, e.normal);
    }
    case EmitterShape::disk:
        return sees_it_shine(e, point) ? over_solid_angle(1 / e.area, point, hit, e.normal) : 0;
    case EmitterShape::sphere: {
        if (const auto cone = cone_of(e, point)) return 1 / (2 * kPi * cone->one_minus_cosine);
        return e.two_sided ? over_solid_angle(1 / e.area, point, hit, normalize(hit - e.corner)) : 0;
    }
    case EmitterShape::ellipsoid:
        return pdf_ellipsoid(e, point, hit);
    }
    return 0;
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
