// Directions to a sun drawn side by side: sun.h's sample() for many, operation for operation, compiled for AVX-512, AVX2,
// SSE4, NEON and none of them.
//
// Promise  the same bits as of one, on every processor.
#pragma once

#include "renderer/lights/sun.h"

#include <span>

namespace renderer {

// Fills out[i] from u[i].
using DrawTowardsSun = void (*)(const Sun& sun, std::span<const Sample2> u, std::span<Vec3d> out);

// Those that this processor can run, the best first; and that one.
std::span<const DrawTowardsSun> all_draw_towards_sun();
DrawTowardsSun draw_towards_sun();

} // namespace renderer
