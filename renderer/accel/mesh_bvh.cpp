#include "renderer/accel/mesh_bvh.h"

#include "renderer/accel/exact_test.h"
#include "renderer/accel/ray_run.h"
#include "renderer/math/floating_point_mode.h"

#include <algorithm>
#include <limits>

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
    const double size = max_component(abs(ray.direction)), scale = static_cast<double>(scale_);
    const double direction_scale = std::exp2(-std::floor(std::log2(size)));
    const WatertightRay<double> exact(ray.origin * scale, ray.direction * direction_scale);
    const double units = scale / direction_scale;
    MeshHit best{std::numeric_limits<double>::infinity(), TriangleBlock::kNone, {}};
    for (const TriangleBlock& block : leaves_)
        for (unsigned lane = 0; lane < TriangleBlock::kLanes; ++lane)
            improve_hit(exact, ray.t_min * units, ray.t_max * units, block, lane, best);
    if (best.primitive == TriangleBlock::kNone) return std::nullopt;
    best.t *= direction_scale / scale;
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
