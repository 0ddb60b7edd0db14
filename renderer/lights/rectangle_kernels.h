// Points of a rectangle as many points see it, drawn side by side: what SphericalRectangle does for one, operation for
// operation, compiled for AVX-512, AVX2, SSE4, NEON and none of them.
//
// Frame    of the scene which is traced.
// Promise  the same bits as emitter.h's sample() of one point, on every processor.
// Cost     about a quarter of that; no allocation.
#pragma once

#include "renderer/math/vec3.h"

#include <cstddef>
#include <span>

namespace renderer {

struct RectangleRun {
    static constexpr std::size_t kPoints = 64, kMostLanes = 8;
    template <typename T>
    using Lanes = T[kPoints];

    // Given: the points that look, and the numbers to draw with. The kMostLanes - 1 behind the last are drawn as well: they
    // hold numbers too.
    alignas(64) Lanes<double> point[3];
    alignas(64) Lanes<double> u0, u1;
    // Found: the unit direction and the distance to a point of the rectangle, and the solid angle it covers.
    alignas(64) Lanes<double> direction[3], distance, solid_angle;
};

// A rectangle as SphericalRectangle takes it.
struct RectangleView {
    Vec3d corner, x, y, z;
    double width, height;
};

// Fills what is to be found for the first `count` points of the run, and more that are not to be read.
using DrawOnRectangle = void (*)(const RectangleView& rectangle, RectangleRun& run, std::size_t count);

// Those that this processor can run, the best first; and that one.
std::span<const DrawOnRectangle> all_draw_on_rectangle();
DrawOnRectangle draw_on_rectangle();

} // namespace renderer
