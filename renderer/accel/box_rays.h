// BoxRays: a run of rays side by side, for the boxes of the upper level.
//
// Frame    the world, in double. Boxes are met as if larger by the slack of double arithmetic on each ray.
// Promise  SlabRay's: signed zeros, zero directions and flat boxes keep their hits.
#pragma once

#include "renderer/geometry/box.h"
#include "renderer/geometry/ray.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace renderer {

struct BoxRays {
    static constexpr unsigned kRays = 64, kStep = 8; // lanes come in steps
    template <typename T>
    using Lanes = T[kRays];

    alignas(64) Lanes<double> near_origin[3], far_origin[3], near_inverse[3], far_inverse[3];
    alignas(64) Lanes<double> begin;
    alignas(64) Lanes<double> end; // what is behind it does not matter; -infinity: nor does the ray
    std::uint64_t rays = 0;        // bit i: ray i is there and traceable
    unsigned lanes = 0;            // in use, a multiple of kStep

    // At most kRays rays; `bounds` of all boxes to come.
    BoxRays(std::span<const Ray> given, const Bounds3d& bounds)
    {
        const double size = std::max(max_abs(bounds.lower), max_abs(bounds.upper));
        lanes = (static_cast<unsigned>(given.size()) + kStep - 1) / kStep * kStep;
        for (unsigned i = 0; i < lanes; ++i) {
            const bool traceable = i < given.size() && is_traceable(given[i]);
            const Ray ray = traceable ? given[i] : Ray{};
            const SlabRay<double> slabs(
                ray.origin, reciprocal(ray.direction), 0x1p-49 * (max_abs(ray.origin) + size));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                near_origin[axis][i] = slabs.near_origin[axis];
                far_origin[axis][i] = slabs.far_origin[axis];
                near_inverse[axis][i] = slabs.near_inverse[axis];
                far_inverse[axis][i] = slabs.far_inverse[axis];
            }
            begin[i] = ray.t_min;
            end[i] = traceable ? ray.t_max : -std::numeric_limits<double>::infinity();
            if (traceable) rays |= std::uint64_t{1} << i;
        }
    }

    SlabRay<double> one(unsigned ray) const
    {
        const auto gather = [ray](const Lanes<double>(&of)[3]) {
            return Vec3d{of[0][ray], of[1][ray], of[2][ray]};
        };
        SlabRay<double> slabs;
        slabs.near_origin = gather(near_origin);
        slabs.far_origin = gather(far_origin);
        slabs.near_inverse = gather(near_inverse);
        slabs.far_inverse = gather(far_inverse);
        slabs.negative_x = std::signbit(slabs.near_inverse.x);
        slabs.negative_y = std::signbit(slabs.near_inverse.y);
        slabs.negative_z = std::signbit(slabs.near_inverse.z);
        return slabs;
    }
};

} // namespace renderer
