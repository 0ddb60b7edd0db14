// RayFan: up to 64 rays whose lines pass through one point, its apex: a pinhole camera's, or shadow rays at a
// light of no size. Seen from there, a triangle is three planes and a box four, for all rays alike.
//
// Frame    the mesh's coordinates, named anew: x and y across, z along, which is away from the apex into the main
//          direction of the rays; depths count from the apex along z. A ray is its two slopes and the depths between
//          which it runs, in float; rays that end at the apex are looked at from their end.
// Promise  whatever the double test can hit is within what the float numbers say, taken with `aside` and the
//          roundings that fan_leaf-inl.h and fan_sides-inl.h name.
#pragma once

#include "renderer/accel/wide_bvh.h"
#include "renderer/math/vec3.h"

#include <cstddef>
#include <cstdint>

namespace renderer {

struct RayFan {
    static constexpr unsigned kRays = 64, kGroup = 8, kGroups = kRays / kGroup;
    template <typename T>
    using Lanes = T[kRays];

    unsigned count = 0;              // rays that are there; the lanes behind them are copies of the last one
    std::size_t x = 0, y = 1, z = 2; // axes of the mesh
    bool turned = false;             // depths grow towards lower coordinates
    unsigned most_leaves = 0;        // that the rays visit together
    Vec3d apex;                      // x, y, z as named above, in the mesh's coordinates
    float apex_high[3], apex_low[3]; // their sum is the apex, up to 2^-48 of it; z as depths grow
    float aside = 0;                 // how far the lines pass from the apex at most
    float reach = 0;                 // how far the rays' origins are from it
    float size = 0;                  // of the largest coordinate of the mesh's bounds
    float blur = 0;    // 4 * aside and what corners seen from the apex may be off by, for their size
    float rounded = 0; // twice the size where corners are more than floats, else 0

    alignas(64) Lanes<float> slope_x, slope_y;
    alignas(64) Lanes<float> begin, end; // nothing can be hit before and behind; hits draw `end` in
    alignas(64) Lanes<float> after;      // what is behind `after` is certainly not too early,
    alignas(64) Lanes<float> before;     // what is before `before` is certainly the best so far

    // The same of groups of rays, each bounded as a whole.
    alignas(32) float least_x[kGroups], most_x[kGroups], least_y[kGroups], most_y[kGroups];
    alignas(32) float group_begin[kGroups], group_end[kGroups];
    // And of all of them.
    float all_least_x, all_most_x, all_least_y, all_most_y, all_begin;
    float middle_x, half_x, middle_y,
        half_y; // what is within half of the middle holds all slopes, roundings too

    unsigned groups() const { return (count + kGroup - 1) / kGroup; }
    double sign() const { return turned ? -1 : 1; }
};

} // namespace renderer
