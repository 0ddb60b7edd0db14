#include "renderer/accel/mesh_bvh.h"

#include "renderer/accel/exact_ray.h"
#include "renderer/accel/exact_test.h"
#include "renderer/accel/ray_run.h"
#include "renderer/accel/reinsertion.h"
#include "renderer/accel/spatial_bvh.h"
#include "renderer/math/floating_point_mode.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace renderer {

std::optional<MeshBvh> MeshBvh::build(
    const Mesh& mesh, TriangleRun run, BvhSplit split, ThreadPool& pool, const std::stop_token& stop)
{
    const DefaultFloatingPoint subnormal_corners_count;
    MeshBvh built;
    TriangleItems triangles = triangle_items(mesh, run, pool, stop);
    if (stop.stop_requested()) return std::nullopt;
    built.degenerate_ = run.count - triangles.items.size();
    built.bounds_ = triangles.bounds;
    if (triangles.items.empty()) return built;
    built.scale_ = triangles.scale;
    // A pair costs less than a block of triangles, as eight children are looked at together; but counted so, trees
    // get small leaves that are slower, and larger themselves.
    const BvhOptions options{.split = split,
                             .leaf_size = 2 * TriangleBlock::kLanes,
                             .block = TriangleBlock::kLanes,
                             .node_cost = 2};
    std::optional<Bvh<float>> bvh =
        split == BvhSplit::spatial
            ? build_spatial_bvh(mesh, triangles.scale, std::move(triangles.items), options, pool, stop)
            : build_bvh<float>(std::move(triangles.items), options, pool, stop);
    if (!bvh) return std::nullopt;
    if (split != BvhSplit::midpoint) reinsert_largest(*bvh, pool, stop);

    const auto corner = [&](std::uint32_t triangle, std::size_t k) {
        return mesh.positions[mesh.triangles[triangle][k]] * built.scale_;
    };
    const bool rounded = !mesh.residuals.empty();
    const auto residual = [&](std::uint32_t triangle, std::size_t k) {
        return mesh.residuals[mesh.triangles[triangle][k]] * built.scale_;
    };
    const LeafFiller leaves{
        .blocks =
            [](std::uint32_t count) { return (count + TriangleBlock::kLanes - 1) / TriangleBlock::kLanes; },
        .reserve =
            [&](std::uint32_t blocks) {
                built.leaves_ = PlainArray<TriangleBlock>(blocks);
                if (rounded) built.residuals_ = PlainArray<CornerResiduals>(blocks);
            },
        .fill =
            [&](const BvhNode<float>& leaf, std::uint32_t block) {
                TriangleBlock* to = built.leaves_.data() + block;
                for (std::uint32_t i = 0; i == 0 || i < leaf.count || i % TriangleBlock::kLanes != 0; ++i) {
                    const std::uint32_t triangle = bvh->order[leaf.first + std::min(i, leaf.count - 1)];
                    to[i / TriangleBlock::kLanes].set(
                        i % TriangleBlock::kLanes,
                        i < leaf.count ? triangle : TriangleBlock::kNone,
                        {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)});
                    if (rounded)
                        built.residuals_[block + i / TriangleBlock::kLanes].set(
                            i % TriangleBlock::kLanes,
                            {residual(triangle, 0), residual(triangle, 1), residual(triangle, 2)});
                }
            }};
    built.bvh_ = widen(*bvh, leaves, pool);
    const Bounds3f& box = built.bvh_.bounds;
    built.blur_ = static_cast<double>(std::max(max_abs(box.lower), max_abs(box.upper)));
    if (rounded)
        built.blur_ += built.blur_ * 0x1p25; // a float is within 2^-24 of itself of what it stands for
    return built;
}

std::optional<MeshHit> MeshBvh::closest_hit(const Ray& ray, const MeshKernels& kernels) const
{
    MeshHit hit;
    if (!kernels.closest_hit(view(), ray, hit)) return std::nullopt;
    return hit;
}

bool MeshBvh::any_hit(const Ray& ray, const MeshKernels& kernels) const
{
    return kernels.any_hit(view(), ray);
}

// Every triangle, by the double test alone.
std::optional<MeshHit> MeshBvh::closest_hit_brute_force(const Ray& ray) const
{
    if (!is_traceable(ray)) return std::nullopt;
    const ExactRay exact(ray, static_cast<double>(scale_));
    MeshHit best{std::numeric_limits<double>::infinity(), TriangleBlock::kNone, {}};
    const MeshView mesh = view();
    for (const TriangleBlock& block : leaves_)
        for (unsigned lane = 0; lane < TriangleBlock::kLanes; ++lane)
            improve_hit(exact.ray, exact.t_min, exact.t_max, mesh, block, lane, best);
    if (best.primitive == TriangleBlock::kNone) return std::nullopt;
    best.t *= exact.ray_units;
    return best;
}

bool MeshBvh::any_hit_brute_force(const Ray& ray) const
{
    return closest_hit_brute_force(ray).has_value();
}

std::uint64_t MeshBvh::node_bytes() const
{
    return bvh_.nodes.size_bytes();
}

std::uint64_t MeshBvh::size_bytes() const
{
    return sizeof *this + node_bytes() + leaves_.size_bytes() + residuals_.size_bytes();
}

} // namespace renderer
