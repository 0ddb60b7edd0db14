#include "renderer/lights/sample_emitter.h"

#include "renderer/lights/ellipsoid.h"
#include "renderer/lights/rectangle_kernels.h"
#include "renderer/lights/spherical_sampling.h"
#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace renderer {

namespace {

// Seen under less, a flat emitter is as good as a small one: area sampling has little noise there, and the sums of
// angles would have few digits. Above the other one the triangle's formulas lose theirs.
constexpr double kLeastSolidAngle = 1e-3, kMostSolidAngle = 6.2;

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

} // namespace renderer
