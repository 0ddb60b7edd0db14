// triangle_items: the triangles of a mesh that have an area, as the builder of trees takes them.
#pragma once

#include "renderer/accel/plain_array.h"
#include "renderer/accel/split.h"
#include "renderer/geometry/mesh.h"
#include "renderer/parallel/thread_pool.h"

#include <cstdint>
#include <stop_token>

namespace renderer {

struct TriangleRun {
    std::uint32_t first = 0, count = 0;
};

struct TriangleItems {
    PlainArray<BuildItem<float>> items; // in the order of the mesh, in scaled coordinates
    Bounds3f bounds;                    // of their corners, not scaled
    float scale = 1;                    // kernel_scale of these bounds
};

// On all threads of the pool. Where `stop` was requested, what comes back means nothing.
TriangleItems
triangle_items(const Mesh& mesh, TriangleRun run, ThreadPool& pool, const std::stop_token& stop);

} // namespace renderer
