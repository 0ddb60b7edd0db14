// Boxes against rays: the slab test, conservative: it may report a box that the ray just misses, never the
// reverse.
//
// Promise  signed zeros, zero directions, origins on a slab plane (0 * infinity), flat boxes and point boxes
//          keep their hits. Rays that are not traceable miss.
// Source   T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013 (padding of the far side); S. Woop, C.
//          Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, section 5 (moving the
//          origin apart for near and far planes, so that the box test forgives what the triangle test
//          forgives).
// Cost     construction once a ray; then 6 subtractions, 6 products and 6 comparisons a box.
#pragma once

#include "renderer/geometry/ray.h"
#include "renderer/geometry/rounding.h"
#include "renderer/math/bounds.h"

#include <cmath>
#include <limits>
#include <optional>

namespace renderer {

// A ray made ready for many boxes.
template <typename T>
struct SlabRay {
    Vec3<T> near_origin, far_origin;
    Vec3<T> near_inverse, far_inverse;
    bool negative_x = false, negative_y = false, negative_z = false;

    SlabRay() = default;
    // `inverse` is 1 / direction, infinite where that is 0. Boxes are met as if larger by `pad` on every
    // side.
    SlabRay(Vec3<T> origin, Vec3<T> inverse, T pad)
        : negative_x(std::signbit(inverse.x)), negative_y(std::signbit(inverse.y)),
          negative_z(std::signbit(inverse.z))
    {
        const Vec3<T> shift{negative_x ? -pad : pad, negative_y ? -pad : pad, negative_z ? -pad : pad};
        near_origin = origin + shift;
        far_origin = origin - shift;
        // Difference, reciprocal and product each round once, the ray's own narrowing once.
        near_inverse = inverse * (1 - gamma<T>(6));
        far_inverse = inverse * (1 + gamma<T>(6));
    }

    // Where the ray is inside the box, within [begin, end]: entry <= exit if anywhere. A NaN (0 * infinity:
    // the origin lies in a slab's plane and moves along it) loses every comparison, so that slab does not
    // restrict.
    bool meets(Vec3<T> lower, Vec3<T> upper, T begin, T end, T& entry, T& exit) const
    {
        entry = begin;
        exit = end;
        const auto slab = [&](T near_plane, T far_plane, T near_o, T far_o, T near_i, T far_i) {
            const T t_near = (near_plane - near_o) * near_i, t_far = (far_plane - far_o) * far_i;
            entry = t_near > entry ? t_near : entry;
            exit = t_far < exit ? t_far : exit;
        };
        slab(negative_x ? upper.x : lower.x,
             negative_x ? lower.x : upper.x,
             near_origin.x,
             far_origin.x,
             near_inverse.x,
             far_inverse.x);
        slab(negative_y ? upper.y : lower.y,
             negative_y ? lower.y : upper.y,
             near_origin.y,
             far_origin.y,
             near_inverse.y,
             far_inverse.y);
        slab(negative_z ? upper.z : lower.z,
             negative_z ? lower.z : upper.z,
             near_origin.z,
             far_origin.z,
             near_inverse.z,
             far_inverse.z);
        return entry <= exit;
    }
};

template <typename T>
constexpr Vec3<T> reciprocal(Vec3<T> v)
{
    return {1 / v.x, 1 / v.y, 1 / v.z};
}

template <typename T>
struct BoxHit {
    T entry, exit; // within the ray's range
};

// The part of the ray inside the box, boundary included.
template <typename T>
std::optional<BoxHit<T>> intersect_box(const Bounds3<T>& box, const BasicRay<T>& ray)
{
    if (!is_traceable(ray) || box.empty()) return std::nullopt;
    BoxHit<T> hit{};
    const SlabRay<T> slabs(ray.origin, reciprocal(ray.direction), 0);
    if (!slabs.meets(box.lower, box.upper, ray.t_min, ray.t_max, hit.entry, hit.exit)) return std::nullopt;
    return hit;
}

} // namespace renderer
