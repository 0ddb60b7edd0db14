// Where rays met triangles of one placed mesh, worked out side by side: triangle_point() and Placement::to_world() for
// several hits, operation for operation, compiled for AVX-512, AVX2, SSE4, NEON and none of them.
//
// Frame    given in the mesh's own frame, found in both.
// Promise  the same bits as of one hit, on every processor.
#pragma once

#include "renderer/accel/placement.h"

#include <cstddef>
#include <span>

namespace renderer {

struct SurfaceLanes {
    static constexpr std::size_t kHits = 8;
    using Vectors = double[3][kHits]; // by axis

    // Given. Lanes that are not used hold what a triangle may be.
    alignas(64) Vectors corner[3];
    alignas(64) Vectors weights;
    // Found: the place on the mesh, and there the SurfacePoint in the world.
    alignas(64) Vectors object_position;
    alignas(64) Vectors position, error, normal;
};

using FindSurfaces = void (*)(const Placement& placement, SurfaceLanes& lanes);

// Those that this processor can run, the best first; and that one.
std::span<const FindSurfaces> all_find_surfaces();
FindSurfaces find_surfaces();

} // namespace renderer
