// RayRun: up to 16 rays side by side, as the mesh kernels see them: exact in double, and float copies that say
// how far off they may be.
//
// Frame    the mesh's coordinates times a power of two, so that products of coordinates stay within float's
//          range; each direction is brought to a length near 1 by a power of two as well, so t counts in units
//          of the kernel.
// Promise  whatever the double test can hit, the float copy meets when boxes and triangles are taken larger by
//          `lateral`.
#pragma once

#include "renderer/geometry/triangle.h"
#include "renderer/math/bounds.h"
#include "renderer/math/vec3.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace renderer {

struct RayRun {
    static constexpr unsigned kRays = 16;
    template <typename T>
    using Lanes = T[kRays];

    std::uint32_t rays = 0; // bit i: ray i is there, traceable, and meets the mesh's bounds

    // Exact.
    alignas(64) Lanes<double> origin[3];
    alignas(64) Lanes<double> direction[3];
    alignas(64) Lanes<double> t_min, t_max;
    alignas(64) Lanes<double> sx, sy, sz; // WatertightRay's
    alignas(64) Lanes<double> ray_units;  // t of the ray = t of the kernel * ray_units
    alignas(64) Lanes<double> blur;       // where double itself may be off
    alignas(64) Lanes<double> start;      // where the float copy starts: no later than the mesh's bounds
    Lanes<std::uint8_t> kx, ky, kz;       // WatertightRay's

    // Float copies, t counted from `start`.
    alignas(64) Lanes<float> from[3];
    alignas(64) Lanes<float> shear_x, shear_y, depth_scale;
    // A box is entered along each axis at plane * near_scale + near_shift, left at plane * far_scale + far_shift.
    alignas(64) Lanes<float> near_scale[3], near_shift[3], far_scale[3], far_shift[3];
    Lanes<std::uint8_t> near_row[3];         // of WideNode::planes; the far one is near_row ^ 1
    alignas(64) Lanes<float> lateral, begin; // nothing before `begin` matters
    alignas(64) Lanes<float> end;            // nor behind `end`, which hits draw in

    WatertightRay<double> exact(unsigned ray) const
    {
        WatertightRay<double> r;
        r.origin = {origin[0][ray], origin[1][ray], origin[2][ray]};
        r.kx = kx[ray];
        r.ky = ky[ray];
        r.kz = kz[ray];
        r.sx = sx[ray];
        r.sy = sy[ray];
        r.sz = sz[ray];
        return r;
    }
    // A float that is certainly behind t.
    float end_for(double t, unsigned ray) const
    {
        const auto nearest = static_cast<float>(t - start[ray]);
        return nearest + std::abs(nearest) * 0x1p-23f + std::numeric_limits<float>::min() + 4 * lateral[ray];
    }
};

// The power of two by which a mesh's coordinates are multiplied; 1 where their size is moderate.
float kernel_scale(const Bounds3f& box);

} // namespace renderer
