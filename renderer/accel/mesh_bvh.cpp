#include "renderer/accel/mesh_bvh.h"

#include "renderer/math/floating_point_mode.h"

#include <algorithm>

namespace renderer {

namespace {

// Triangles of the run that have an area, and the bounds of their corners.
struct Kept {
    std::vector<std::uint32_t> triangles;
    Bounds3f bounds;
};

Kept keep_those_with_area(const Mesh& mesh, TriangleRun run)
{
    Kept kept;
    kept.triangles.reserve(run.count);
    for (std::uint32_t i = run.first; i < run.first + run.count; ++i) {
        const Triangle& v = mesh.triangles[i];
        if (is_degenerate(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]])) continue;
        for (const std::uint32_t vertex : v)
            kept.bounds.extend(mesh.positions[vertex]);
        kept.triangles.push_back(i);
    }
    return kept;
}

} // namespace

std::optional<MeshBvh>
MeshBvh::build(const Mesh& mesh, TriangleRun run, BvhSplit split, ThreadPool& pool, std::stop_token stop)
{
    const DefaultFloatingPoint subnormal_corners_count;
    MeshBvh built;
    const Kept kept = keep_those_with_area(mesh, run);
    built.degenerate_ = run.count - kept.triangles.size();
    built.bounds_ = kept.bounds;
    if (kept.triangles.empty()) return built;
    built.scale_ = kernel_scale(built.bounds_);
    const auto corner = [&](std::uint32_t triangle, std::size_t k) {
        return mesh.positions[mesh.triangles[triangle][k]] * built.scale_;
    };
    std::vector<Bounds3f> boxes(kept.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
            boxes[i].extend(corner(kept.triangles[i], k));
    const BvhOptions options{
        .split = split, .leaf_size = 2 * TriangleBlock::kLanes, .block = TriangleBlock::kLanes};
    const std::optional<Bvh<float>> bvh = build_bvh<float>(boxes, options, pool, std::move(stop));
    if (!bvh) return std::nullopt;

    built.leaves_.reserve(kept.triangles.size() / 3);
    built.bvh_ = widen(*bvh, [&](std::uint32_t first, std::uint32_t count) {
        const BlockRun blocks{static_cast<std::uint32_t>(built.leaves_.size()),
                              (count + TriangleBlock::kLanes - 1) / TriangleBlock::kLanes};
        for (std::uint32_t i = 0; i < blocks.count * TriangleBlock::kLanes; ++i) {
            if (i % TriangleBlock::kLanes == 0) built.leaves_.emplace_back();
            const std::uint32_t triangle = kept.triangles[bvh->order[first + std::min(i, count - 1)]];
            built.leaves_.back().set(i % TriangleBlock::kLanes,
                                     i < count ? triangle : TriangleBlock::kNone,
                                     {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)});
        }
        return blocks;
    });
    built.leaves_.shrink_to_fit();
    return built;
}

// The double test of one triangle, drawn in to the best hit so far. True where it became the best.
bool MeshBvh::test(const KernelRay& ray,
                   const TriangleBlock& block,
                   unsigned lane,
                   std::optional<MeshHit>& best)
{
    const std::uint32_t primitive = block.primitive[lane];
    if (primitive == TriangleBlock::kNone) return false;
    const auto hit = intersect_watertight(
        ray.exact, ray.t_min, ray.t_max, block.corner(0, lane), block.corner(1, lane), block.corner(2, lane));
    if (!hit) return false;
    if (best && (hit->t > best->t || (hit->t == best->t && primitive > best->primitive))) return false;
    best = {hit->t, primitive, hit->barycentrics};
    return true;
}

template <bool kAnyHit>
std::optional<MeshHit> MeshBvh::trace(const Ray& ray) const
{
    std::optional<MeshHit> best;
    KernelRay kernel;
    if (leaves_.empty() || !kernel.prepare(ray, bvh_.bounds, scale_)) return best;
    const auto leaf = [&](std::uint32_t first, std::uint32_t blocks, float& end) {
        for (std::uint32_t i = first; i < first + blocks; ++i)
            for (unsigned lanes = kernel.may_hit(leaves_[i], end); lanes != 0; lanes &= lanes - 1) {
                if (!test(kernel, leaves_[i], static_cast<unsigned>(__builtin_ctz(lanes)), best)) continue;
                if (kAnyHit) return true;
                end = std::min(end, kernel.end_for(best->t));
            }
        return false;
    };
    traverse(bvh_, kernel.slabs, kernel.begin(), kernel.end_for(kernel.t_max), leaf);
    if (best) best->t *= kernel.ray_units;
    return best;
}

std::optional<MeshHit> MeshBvh::closest_hit(const Ray& ray) const
{
    return trace<false>(ray);
}

bool MeshBvh::any_hit(const Ray& ray) const
{
    return trace<true>(ray).has_value();
}

// Every triangle, by the double test alone.
std::optional<MeshHit> MeshBvh::closest_hit_brute_force(const Ray& ray) const
{
    std::optional<MeshHit> best;
    KernelRay kernel;
    if (!kernel.prepare_exact(ray, scale_)) return best;
    for (const TriangleBlock& block : leaves_)
        for (unsigned lane = 0; lane < TriangleBlock::kLanes; ++lane)
            test(kernel, block, lane, best);
    if (best) best->t *= kernel.ray_units;
    return best;
}

bool MeshBvh::any_hit_brute_force(const Ray& ray) const
{
    return closest_hit_brute_force(ray).has_value();
}

std::uint64_t MeshBvh::node_bytes() const
{
    return bvh_.nodes.capacity() * sizeof(WideNode);
}

std::uint64_t MeshBvh::size_bytes() const
{
    return sizeof *this + node_bytes() + leaves_.capacity() * sizeof(TriangleBlock);
}

} // namespace renderer
