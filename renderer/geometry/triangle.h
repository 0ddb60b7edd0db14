// Triangles against rays: the watertight test that the renderer uses, and Moller-Trumbore to measure it
// against.
//
// Conventions  a ray in the triangle's plane misses; a triangle without area is never hit; edges and corners
//              belong to every triangle that has them, so a ray through a shared edge hits at least one of
//              the two.
// Range        t_min < t < t_max, where t must exceed t_min by its own rounding error: a ray that starts on
//              the triangle does not hit it. Magnitudes are to stay within the square root of the type's
//              range.
// Source       S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013; error
//              of t: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd ed., section 3.9.6;
//              T. Moller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
// Cost         no allocation, never throws.
#pragma once

#include "renderer/geometry/ray.h"
#include "renderer/geometry/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace renderer {

template <typename T>
struct TriangleHit {
    T t;
    Vec3<T> barycentrics; // weights of a, b, c; each in [0, 1]
};

// True where a, b, c lie on a line. Exact for float corners while the edges' exponents are within 2^28 of
// each other.
template <typename T>
bool is_degenerate(Vec3<T> a, Vec3<T> b, Vec3<T> c)
{
    const auto wide = [](Vec3<T> v) { return Vec3d{v.x, v.y, v.z}; };
    return cross(wide(b) - wide(a), wide(c) - wide(a)) == Vec3d{};
}

// A ray made ready for many triangles: axes renamed so that the ray runs along z, then sheared onto it.
template <typename T>
struct WatertightRay {
    Vec3<T> origin;
    std::size_t kx = 0, ky = 1, kz = 2;
    T sx = 0, sy = 0, sz = 1;

    WatertightRay() = default;
    WatertightRay(Vec3<T> ray_origin, Vec3<T> direction) : origin(ray_origin)
    {
        const Vec3<T> size = abs(direction);
        kz = size.x > size.y ? (size.x > size.z ? 0u : 2u) : (size.y > size.z ? 1u : 2u);
        // The others in turn; swapped where it runs backwards, which keeps the winding.
        constexpr std::uint8_t kOthers[3][3] = {{1, 2, 1}, {2, 0, 2}, {0, 1, 0}};
        const std::size_t backwards = direction[kz] < 0 ? 1 : 0;
        kx = kOthers[kz][backwards];
        ky = kOthers[kz][backwards + 1];
        sx = direction[kx] / direction[kz];
        sy = direction[ky] / direction[kz];
        sz = 1 / direction[kz];
    }
};

namespace watertight {

// Corner in the ray's frame: the ray is x = y = 0, z counts in units of t.
template <typename T>
struct Corner {
    T x, y, z, depth;
};

template <typename T>
Corner<T> shear(const WatertightRay<T>& ray, Vec3<T> v)
{
    const Vec3<T> p = v - ray.origin;
    const T depth = p[ray.kz];
    return {p[ray.kx] - ray.sx * depth, p[ray.ky] - ray.sy * depth, ray.sz * depth, depth};
}

// Twice the signed area of the origin and the edge from p to q. The two triangles at an edge get exactly
// opposite values; a sign is never wrong, since rounding is monotone: at worst the value is 0.
template <typename T>
T edge(const Corner<T>& p, const Corner<T>& q)
{
    return q.x * p.y - q.y * p.x;
}

// The same where that is 0, from the exact products: 0 counts as inside, so it must be no other value rounded. Else a
// triangle that is small for its distance from the ray is hit from far beside it, two of its edges being 0.
inline float exact_edge(const Corner<float>& p, const Corner<float>& q)
{
    return static_cast<float>(double{q.x} * double{p.y} - double{q.y} * double{p.x});
}
inline double exact_edge(const Corner<double>& p, const Corner<double>& q)
{
    return std::fma(q.x, p.y, -(q.x * p.y)) - std::fma(q.y, p.x, -(q.y * p.x)); // the products' rests
}

template <typename T>
T max3(T a, T b, T c)
{
    return std::max(std::max(std::abs(a), std::abs(b)), std::abs(c));
}

// The least that the true t can be, given the t computed.
template <typename T>
T lower_bound_of_t(
    T t, T inv_det, const Vec3<T>& e, const Corner<T>& a, const Corner<T>& b, const Corner<T>& c)
{
    const T max_z = max3(a.z, b.z, c.z), depth = max3(a.depth, b.depth, c.depth);
    const T max_x = max3(a.x, b.x, c.x), max_y = max3(a.y, b.y, c.y), max_e = max3(e.x, e.y, e.z);
    const T delta_x = gamma<T>(5) * (max_x + depth), delta_y = gamma<T>(5) * (max_y + depth);
    const T delta_z = gamma<T>(3) * max_z;
    const T delta_e = 2 * (gamma<T>(2) * max_x * max_y + delta_y * max_x + delta_x * max_y);
    const T delta_t =
        3 * (gamma<T>(3) * max_e * max_z + delta_e * max_z + delta_z * max_e) * std::abs(inv_det);
    // t is a weighted mean of the corners' z: it cannot be less than the least of them, however thin the
    // triangle.
    const T least = std::min(std::min(a.z, b.z), c.z) - delta_z;
    return t - delta_t > least ? t - delta_t : least;
}

// In a thin triangle the weights are poorly determined along its length, and the point they make lies off the
// ray. This moves weight between the ends of the longest edge until the point is beside the ray again; the
// weights stay within [0, 1]. Nothing changes where the point is on the ray to rounding.
template <typename T>
Vec3<T> draw_onto_ray(Vec3<T> weights, const Corner<T>& a, const Corner<T>& b, const Corner<T>& c)
{
    const T x = weights.x * a.x + weights.y * b.x + weights.z * c.x;
    const T y = weights.x * a.y + weights.y * b.y + weights.z * c.y;
    const T size = std::max(max3(a.x, b.x, c.x), max3(a.y, b.y, c.y));
    if (!(std::max(std::abs(x), std::abs(y)) > gamma<T>(16) * size)) return weights;
    const Corner<T>* const corners[3] = {&a, &b, &c};
    std::size_t from = 0, to = 1;
    T longest = -1, along = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = i == 2 ? 0 : i + 1;
        const T ex = corners[j]->x - corners[i]->x, ey = corners[j]->y - corners[i]->y;
        const T squared = ex * ex + ey * ey;
        if (squared <= longest) continue;
        longest = squared;
        from = i;
        to = j;
        along = (x * ex + y * ey) / squared;
    }
    if (!(longest > 0)) return weights;
    const T shift = std::clamp(along, -weights[from], weights[to]);
    weights[from] += shift;
    weights[to] -= shift;
    return weights;
}

} // namespace watertight

// For many triangles: the ray is traceable and the triangle not degenerate, as the caller has seen to. Inlined: as a
// call it takes a twentieth more of a ray's instructions.
template <typename T>
[[gnu::always_inline]] inline std::optional<TriangleHit<T>>
intersect_watertight(const WatertightRay<T>& ray, T t_min, T t_max, Vec3<T> a, Vec3<T> b, Vec3<T> c)
{
    namespace wt = watertight;
    const wt::Corner<T> pa = wt::shear(ray, a), pb = wt::shear(ray, b), pc = wt::shear(ray, c);
    Vec3<T> e{wt::edge(pb, pc), wt::edge(pc, pa), wt::edge(pa, pb)};
    const auto beside = [&e] { return (e.x < 0 || e.y < 0 || e.z < 0) && (e.x > 0 || e.y > 0 || e.z > 0); };
    if (beside()) return std::nullopt;
    if (e.x * e.y * e.z == 0) { // some are 0, or almost
        if (e.x == 0) e.x = wt::exact_edge(pb, pc);
        if (e.y == 0) e.y = wt::exact_edge(pc, pa);
        if (e.z == 0) e.z = wt::exact_edge(pa, pb);
        if (beside()) return std::nullopt;
    }
    const T det = e.x + e.y + e.z;
    if (det == 0) return std::nullopt;
    const T inv_det = 1 / det;
    const Vec3<T> weights = wt::draw_onto_ray(e * inv_det, pa, pb, pc);
    const T t = weights.x * pa.z + weights.y * pb.z + weights.z * pc.z;
    if (!(t < t_max) || !(t > t_min)) return std::nullopt;
    if (!(wt::lower_bound_of_t(t, inv_det, e, pa, pb, pc) > t_min)) return std::nullopt;
    return TriangleHit<T>{t, weights};
}

template <typename T>
std::optional<TriangleHit<T>> intersect_watertight(const BasicRay<T>& ray, Vec3<T> a, Vec3<T> b, Vec3<T> c)
{
    if (!is_traceable(ray) || is_degenerate(a, b, c)) return std::nullopt;
    return intersect_watertight(WatertightRay<T>(ray.origin, ray.direction), ray.t_min, ray.t_max, a, b, c);
}

// Not watertight: rays may slip between two triangles. Kept to be measured against; no renderer code calls
// it.
template <typename T>
std::optional<TriangleHit<T>>
intersect_moller_trumbore(const BasicRay<T>& ray, Vec3<T> a, Vec3<T> b, Vec3<T> c)
{
    if (!is_traceable(ray)) return std::nullopt;
    const Vec3<T> ab = b - a, ac = c - a;
    const Vec3<T> p = cross(ray.direction, ac);
    const T det = dot(ab, p);
    // In-plane within rounding of the determinant itself.
    if (!(std::abs(det) > gamma<T>(6) * max_abs(ab) * max_abs(p))) return std::nullopt;
    const T inv_det = 1 / det;
    const Vec3<T> from_a = ray.origin - a;
    const T u = dot(from_a, p) * inv_det;
    if (!(u >= 0 && u <= 1)) return std::nullopt;
    const Vec3<T> q = cross(from_a, ab);
    const T v = dot(ray.direction, q) * inv_det;
    if (!(v >= 0 && u + v <= 1)) return std::nullopt;
    const T t = dot(ac, q) * inv_det;
    if (!(t > ray.t_min && t < ray.t_max)) return std::nullopt;
    return TriangleHit<T>{t, {1 - u - v, u, v}};
}

} // namespace renderer
