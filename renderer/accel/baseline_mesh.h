// BaselineMesh: a mesh as it is searched without the wide tree and its kernels: a list of all triangles, or a
// binary tree over them. What the renderer's own tree is measured against; never used unless asked for.
//
// Frame, Precision, Ties, Threads  as MeshBvh: the same hits to the last bit.
// Cost     one ray at a time, every triangle that comes up by the exact test alone; a list: all of them, always.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/accel/mesh_bvh.h"
#include "renderer/accel/triangle_block.h"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

namespace renderer {

class BaselineMesh {
public:
    // The mesh has passed validate_mesh, the run lies within it. No split: a list. Nothing if `stop` was requested.
    static std::optional<BaselineMesh> build(const Mesh& mesh,
                                             TriangleRun run,
                                             std::optional<BvhSplit> split,
                                             ThreadPool& pool,
                                             const std::stop_token& stop = {});

    std::optional<MeshHit> closest_hit(const Ray& ray) const;
    bool any_hit(const Ray& ray) const;

    const Bounds3f& bounds() const { return bounds_; } // of triangles with an area; empty if there is none
    std::uint64_t degenerate_triangles() const { return degenerate_; }
    std::uint64_t size_bytes() const;

private:
    template <bool kAnyHit>
    std::optional<MeshHit> trace(const Ray& ray) const;

    std::vector<TriangleBlock> blocks_;      // in scaled coordinates
    std::vector<CornerResiduals> residuals_; // one a block, where the mesh has them
    Bvh<float> tree_;                        // a leaf's `first` is a block. Empty: a list
    Bounds3f bounds_;
    float scale_ = 1; // as MeshBvh's
    std::uint64_t degenerate_ = 0;
};

} // namespace renderer
