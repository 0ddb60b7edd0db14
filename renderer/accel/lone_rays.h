// LoneRays: up to 64 rays that are followed one by one, side by side: float copies that boxes and triangles are
// looked at with, and what little of the exact rays is needed to make those again.
//
// Frame    the mesh's coordinates times a power of two; directions brought to a length near 1 by a power of two
//          as well. t of the float copies counts from `start`, in units of the kernel.
// Promise  as RayRun's: whatever the double test can hit, the float copy meets when boxes and triangles are
//          taken larger by `lateral`; depths along the ray are within 4 `lateral` of the double ones.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace renderer {

struct LoneRays {
    static constexpr unsigned kRays = 64;
    template <typename T>
    using Lanes = T[kRays];

    std::uint64_t rays = 0; // bit i: ray i is there, traceable, and meets the mesh's bounds

    // A box is entered along each axis at plane * inverse + near_shift, left at plane * inverse + far_shift.
    alignas(64) Lanes<float> inverse[3];
    alignas(64) Lanes<float> near_shift[3], far_shift[3];
    Lanes<std::uint32_t> near_row[3]; // of WideNode::planes, in bytes; the far one is near_row ^ 32
    alignas(64) Lanes<float> begin;   // nothing before it matters
    alignas(64) Lanes<float> end;     // nor behind it; hits draw it in

    // The triangle test: the ray's start with its axes renamed, then its shear.
    alignas(64) Lanes<float> from_x, from_y, from_z;
    alignas(64) Lanes<float> shear_x, shear_y, depth_scale;
    alignas(64) Lanes<float> lateral;
    alignas(64) Lanes<float> near_lateral; // of what is right at the start; more farther on
    alignas(64) Lanes<float> limit;        // a hit before it is certainly before t_max
    struct Axes {
        std::uint8_t x, y, z; // of TriangleBlock::corners, in bytes
    };
    Lanes<Axes> axes;

    // Exact.
    alignas(64) Lanes<double> start;     // where t of the float copies begins
    alignas(64) Lanes<double> power;     // what the direction is multiplied by
    alignas(64) Lanes<double> units;     // t of the kernel = t of the ray * units
    alignas(64) Lanes<double> ray_units; // and back

    // A float that is certainly behind t.
    float end_for(double t, unsigned ray) const
    {
        const auto nearest = static_cast<float>(t - start[ray]);
        return nearest + std::abs(nearest) * 0x1p-23f + std::numeric_limits<float>::min() + 4 * lateral[ray];
    }
};

} // namespace renderer
