// Mesh kernels: the loops that follow rays through one prepared mesh, once for every instruction set that this
// processor has; chosen at run time.
//
// Promise  every kernel gives the same hits to the last bit: vectors only leave out what cannot be hit, and
//          what is left is decided in double by one and the same test.
// Threads  any number at once. Cost: no allocation, no lock; one indirect call a ray or a run of rays.
#pragma once

#include "renderer/accel/box_rays.h"
#include "renderer/accel/mesh_hit.h"
#include "renderer/accel/shared_walks.h"
#include "renderer/accel/triangle_block.h"
#include "renderer/accel/wide_bvh.h"
#include "renderer/geometry/ray.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace renderer {

// What a kernel reads of a mesh: in coordinates that were multiplied by `scale`.
struct MeshView {
    const WideNode* nodes = nullptr; // the root is first; none where there is nothing to hit
    const TriangleBlock* leaves = nullptr;
    std::size_t blocks = 0;                     // of the leaves
    const CornerResiduals* residuals = nullptr; // one a block; none where floats hold the corners
    Bounds3f bounds;
    float scale = 1;
    // What double arithmetic on a corner is off by, times 2^49: its size, and much more where the corners that the
    // kernels see lack residuals.
    double blur = 0;
    FanWalks* fans = nullptr; // whether they have paid; none: all are tried
};

struct MeshKernels {
    const char* name; // "AVX2"
    // False: a miss, and `hit` is as it was.
    bool (*closest_hit)(const MeshView& mesh, const Ray& ray, MeshHit& hit);
    bool (*any_hit)(const MeshView& mesh, const Ray& ray);
    // The same for kMostRays rays at most: bit i of the result is set where ray i hit; hits[i] says where, if so.
    // Rays that run alike, or through one point, are followed together.
    std::uint64_t (*closest_hits)(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits);
    std::uint64_t (*any_hits)(const MeshView& mesh, const Ray* rays, unsigned count);

    // Any number of rays that have nothing in common, best by the dozen; see MeshBvh.
    void (*closest_hits_apart)(const MeshView& mesh, const Ray* rays, std::size_t count, MeshHit* hits);
    void (*any_hits_apart)(const MeshView& mesh, const Ray* rays, std::size_t count, MeshHit* hits);

    // Rays of the run that are inside a box within [begin, end], and where the first of them enters.
    std::uint64_t (*enter_box)(const BoxRays& rays, const Vec3d& lower, const Vec3d& upper, double& nearest);

    static constexpr unsigned kMostRays = 64;
};

// The best of this processor.
const MeshKernels& mesh_kernels();

// All that this processor can run, the best first; the portable one is the last. For tests and measuring.
std::span<const MeshKernels> all_mesh_kernels();

} // namespace renderer
