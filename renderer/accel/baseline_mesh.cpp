#include "renderer/accel/baseline_mesh.h"

#include "renderer/accel/exact_ray.h"
#include "renderer/accel/exact_test.h"
#include "renderer/accel/traverse.h"
#include "renderer/accel/triangle_items.h"
#include "renderer/math/floating_point_mode.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace renderer {

namespace {

constexpr std::uint32_t kLanes = TriangleBlock::kLanes;

std::uint32_t blocks_for(std::uint32_t triangles)
{
    return (triangles + kLanes - 1) / kLanes;
}

} // namespace

std::optional<BaselineMesh> BaselineMesh::build(const Mesh& mesh,
                                                TriangleRun run,
                                                std::optional<BvhSplit> split,
                                                ThreadPool& pool,
                                                const std::stop_token& stop)
{
    const DefaultFloatingPoint subnormal_corners_count;
    TriangleItems triangles = triangle_items(mesh, run, pool, stop);
    if (stop.stop_requested()) return std::nullopt;
    BaselineMesh built;
    built.degenerate_ = run.count - triangles.items.size();
    built.bounds_ = triangles.bounds;
    built.scale_ = triangles.scale;
    // Appends triangle_of(0), triangle_of(1), ...; the number of their first block.
    const auto add_blocks = [&](std::uint32_t count, const auto& triangle_of) {
        const auto first = static_cast<std::uint32_t>(built.blocks_.size());
        for (std::uint32_t i = 0; i < blocks_for(count) * kLanes; ++i) {
            if (i % kLanes == 0) built.blocks_.emplace_back();
            const std::uint32_t triangle = triangle_of(std::min(i, count - 1));
            const Triangle& v = mesh.triangles[triangle];
            built.blocks_.back().set(i % kLanes,
                                     i < count ? triangle : TriangleBlock::kNone,
                                     {mesh.positions[v[0]] * built.scale_,
                                      mesh.positions[v[1]] * built.scale_,
                                      mesh.positions[v[2]] * built.scale_});
            if (mesh.residuals.empty()) continue;
            if (i % kLanes == 0) built.residuals_.emplace_back();
            built.residuals_.back().set(i % kLanes,
                                        {mesh.residuals[v[0]] * built.scale_,
                                         mesh.residuals[v[1]] * built.scale_,
                                         mesh.residuals[v[2]] * built.scale_});
        }
        return first;
    };
    if (triangles.items.empty()) return built;
    if (!split) {
        add_blocks(static_cast<std::uint32_t>(triangles.items.size()),
                   [&](std::uint32_t i) { return triangles.items[i].primitive; });
        return built;
    }
    std::optional<Bvh<float>> tree =
        build_bvh<float>(std::move(triangles.items), {.split = *split}, pool, stop);
    if (!tree) return std::nullopt;
    const auto settle = [&](BvhNode<float>& node) {
        if (node.count != 0)
            node.first = add_blocks(
                node.count, [&, first = node.first](std::uint32_t i) { return tree->order[first + i]; });
    };
    settle(tree->root);
    for (BvhPair<float>& pair : tree->pairs)
        for (BvhNode<float>& child : pair.child)
            settle(child);
    built.tree_ = std::move(*tree);
    return built;
}

template <bool kAnyHit>
std::optional<MeshHit> BaselineMesh::trace(const Ray& ray) const
{
    if (blocks_.empty() || !is_traceable(ray)) return std::nullopt;
    const ExactRay exact(ray, static_cast<double>(scale_));
    MeshView view;
    view.leaves = blocks_.data();
    view.residuals = residuals_.empty() ? nullptr : residuals_.data();
    MeshHit best{std::numeric_limits<double>::infinity(), TriangleBlock::kNone, {}};
    const auto found = [&] { return best.primitive != TriangleBlock::kNone; };
    const auto test = [&](const TriangleBlock& block) {
        for (unsigned lane = 0; lane < kLanes; ++lane)
            if (improve_hit(exact.ray, exact.t_min, exact.t_max, view, block, lane, best) && kAnyHit) return;
    };
    if (tree_.empty()) {
        for (const TriangleBlock& block : blocks_) {
            test(block);
            if (kAnyHit && found()) break;
        }
    } else {
        // What the exact test takes for a hit lies within 2^-48 of all coordinates' size beside the ray.
        const Vec3d reach = abs(to_double(tree_.root.lower)) + abs(to_double(tree_.root.upper));
        const double pad = 0x1p-46 * (max_component(abs(exact.ray.origin)) + max_component(reach));
        const SlabRay<double> slabs(exact.ray.origin, reciprocal(exact.direction), pad);
        traverse(tree_,
                 slabs,
                 exact.t_min,
                 exact.t_max,
                 [&](std::uint32_t first, std::uint32_t count, double& end) {
                     for (std::uint32_t i = 0; i < blocks_for(count); ++i)
                         test(blocks_[first + i]);
                     if (found()) end = std::min(end, best.t);
                     return kAnyHit && found();
                 });
    }
    if (!found()) return std::nullopt;
    best.t *= exact.ray_units;
    return best;
}

std::optional<MeshHit> BaselineMesh::closest_hit(const Ray& ray) const
{
    return trace<false>(ray);
}

bool BaselineMesh::any_hit(const Ray& ray) const
{
    return trace<true>(ray).has_value();
}

std::uint64_t BaselineMesh::size_bytes() const
{
    return sizeof *this + tree_.size_bytes() + blocks_.capacity() * sizeof(TriangleBlock) +
           residuals_.capacity() * sizeof(CornerResiduals);
}

} // namespace renderer
