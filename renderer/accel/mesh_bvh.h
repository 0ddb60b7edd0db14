// MeshBvh: the triangles of a mesh, or of a run of them, made ready for rays.
//
// Frame      object space: the mesh's own coordinates. Rays in double.
// Precision  what is hit is decided in double, by intersect_watertight on the corners, which are floats, with
//            residuals where the mesh has them: so a hit is a pure function of (ray, triangle). Boxes and a
//            quick first look at each triangle work in float, on a copy of the ray whose origin was first
//            brought to the mesh's bounds, and pass whatever float cannot tell: they only save work. Hence
//            every kind of tree, and no tree at all, gives the same hit to the last bit.
// Ties       the least (t, primitive) wins.
// Threads    immutable after build but for a hint on which way is the quickest (shared_walks.h); rays may be traced
//            from any number of threads.
#pragma once

#include "renderer/accel/mesh_hit.h"
#include "renderer/accel/mesh_kernels.h"
#include "renderer/accel/shared_walks.h"
#include "renderer/accel/tree_bytes.h"
#include "renderer/accel/triangle_block.h"
#include "renderer/accel/triangle_items.h"
#include "renderer/accel/wide_bvh.h"
#include "renderer/description/settings.h"
#include "renderer/geometry/mesh.h"
#include "renderer/geometry/ray.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>

namespace renderer {

class MeshBvh {
public:
    // The mesh has passed validate_mesh, the run lies within it; the mesh is only read. Nothing if `stop` was
    // requested.
    static std::optional<MeshBvh> build(const Mesh& mesh,
                                        TriangleRun run,
                                        BvhSplit split,
                                        ThreadPool& pool,
                                        const std::stop_token& stop = {});

    std::optional<MeshHit> closest_hit(const Ray& ray, const MeshKernels& kernels = mesh_kernels()) const;
    bool any_hit(const Ray& ray, const MeshKernels& kernels = mesh_kernels()) const;
    // The same for MeshKernels::kMostRays rays at most; see there.
    std::uint64_t closest_hits(std::span<const Ray> rays,
                               std::span<MeshHit> hits,
                               const MeshKernels& kernels = mesh_kernels()) const
    {
        return kernels.closest_hits(view(), rays.data(), static_cast<unsigned>(rays.size()), hits.data());
    }
    std::uint64_t any_hits(std::span<const Ray> rays, const MeshKernels& kernels = mesh_kernels()) const
    {
        return kernels.any_hits(view(), rays.data(), static_cast<unsigned>(rays.size()));
    }
    // Any number of rays that have nothing in common; a ray that misses gets the primitive TriangleBlock::kNone.
    void closest_hits_apart(std::span<const Ray> rays,
                            std::span<MeshHit> hits,
                            const MeshKernels& kernels = mesh_kernels()) const
    {
        kernels.closest_hits_apart(view(), rays.data(), rays.size(), hits.data());
    }
    // As far as that one hits anything at all: a hit has some other primitive, and nothing else is told.
    void any_hits_apart(std::span<const Ray> rays,
                        std::span<MeshHit> hits,
                        const MeshKernels& kernels = mesh_kernels()) const
    {
        kernels.any_hits_apart(view(), rays.data(), rays.size(), hits.data());
    }
    // The same answers from every triangle in turn: for tests and for measuring.
    std::optional<MeshHit> closest_hit_brute_force(const Ray& ray) const;
    bool any_hit_brute_force(const Ray& ray) const;

    // To be kept on disk, and back: valid as long as this is; nothing if the sizes do not fit.
    TreeBytes bytes() const;
    static std::optional<MeshBvh> from_bytes(const TreeBytes& bytes,
                                             const std::shared_ptr<const void>& keeper);

    // Whether fans have paid: to begin anew, for tests and for measuring.
    FanWalks& fans() const { return fans_; }

    const Bounds3f& bounds() const { return bounds_; } // of triangles with an area; empty if there is none
    std::uint64_t degenerate_triangles() const { return degenerate_; }
    std::uint64_t size_bytes() const; // nodes, leaves: all that traversal reads
    std::uint64_t node_bytes() const; // the nodes' share of it
    unsigned depth() const { return bvh_.depth; }

private:
    MeshView view() const
    {
        return {bvh_.nodes.empty() ? nullptr : bvh_.nodes.data(),
                leaves_.data(),
                leaves_.size(),
                residuals_.empty() ? nullptr : residuals_.data(),
                bvh_.bounds,
                scale_,
                blur_,
                &fans_};
    }

    WideBvh bvh_;                           // in scaled coordinates
    PlainArray<TriangleBlock> leaves_;      // with copies of the corners, so that a test reads one place
    PlainArray<CornerResiduals> residuals_; // beside the leaves; none where floats hold the corners
    Bounds3f bounds_;
    double blur_ = 0; // MeshView's
    float scale_ = 1; // power of two that brings coordinates near 1 where they are far from it
    std::uint64_t degenerate_ = 0;
    mutable FanWalks fans_; // written while rays are traced: in a line of its own
};

} // namespace renderer
