// Directions around +z by their cosine, drawn side by side: sample_cosine_hemisphere() for many, operation for operation,
// compiled for AVX-512, AVX2, SSE4, NEON and none of them.
//
// Promise  the same bits as of one, on every processor.
#pragma once

#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

#include <cstddef>
#include <span>

namespace renderer {

// Fills out[i] from u[i].
using DrawInHemisphere = void (*)(std::span<const Sample2> u, std::span<Vec3f> out);

// Those that this processor can run, the best first; and that one.
std::span<const DrawInHemisphere> all_draw_in_hemisphere();
DrawInHemisphere draw_in_hemisphere();

} // namespace renderer
