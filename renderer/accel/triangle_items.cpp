#include "renderer/accel/triangle_items.h"

#include "renderer/accel/ray_run.h"
#include "renderer/accel/triangle_part.h"
#include "renderer/geometry/triangle.h"

#include <algorithm>
#include <vector>

namespace renderer {

namespace {

constexpr std::uint32_t kShare = 8192; // triangles that a thread takes at once

struct Share {
    std::size_t kept = 0;
    Bounds3f bounds;
};

// As take(), of corners that are more than floats.
Share take_with_residuals(const Mesh& mesh, std::uint32_t first, std::uint32_t end, BuildItem<float>* to)
{
    Share share;
    for (std::uint32_t i = first; i < end; ++i) {
        const Triangle& v = mesh.triangles[i];
        if (is_degenerate(mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2]))) continue;
        Bounds3f box;
        for (const std::uint32_t vertex : v) {
            box.extend(round_down(mesh.position(vertex)));
            box.extend(round_up(mesh.position(vertex)));
        }
        share.bounds.extend(box);
        to[share.kept++] = {box.lower, i, box.upper};
    }
    return share;
}

Share take(const Mesh& mesh, std::uint32_t first, std::uint32_t end, BuildItem<float>* to)
{
    Share share;
    for (std::uint32_t i = first; i < end; ++i) {
        const Triangle& v = mesh.triangles[i];
        const Vec3f &a = mesh.positions[v[0]], &b = mesh.positions[v[1]], &c = mesh.positions[v[2]];
        if (is_degenerate(a, b, c)) continue;
        Bounds3f box{a, a};
        box.extend(b);
        box.extend(c);
        share.bounds.extend(box);
        to[share.kept++] = {box.lower, i, box.upper};
    }
    return share;
}

} // namespace

TriangleItems triangle_items(const Mesh& mesh, TriangleRun run, ThreadPool& pool, const std::stop_token& stop)
{
    TriangleItems made{PlainArray<BuildItem<float>>(run.count), {}, 1};
    const auto take_share = mesh.residuals.empty() ? take : take_with_residuals;
    std::vector<Share> shares((run.count + kShare - 1) / kShare);
    const auto first_of = [&](std::size_t i) { return static_cast<std::uint32_t>(i) * kShare; };
    pool.run_near(
        shares.size(),
        [&](std::size_t i, unsigned) {
            const std::uint32_t first = first_of(i), end = std::min(run.count, first + kShare);
            shares[i] = take_share(mesh, run.first + first, run.first + end, made.items.data() + first);
        },
        stop);
    if (stop.stop_requested()) return made;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        made.bounds.extend(shares[i].bounds);
        BuildItem<float>* const from = made.items.data() + first_of(i);
        if (kept != first_of(i)) std::copy(from, from + shares[i].kept, made.items.data() + kept);
        kept += shares[i].kept;
    }
    made.items.shorten(kept);
    if (kept == 0) return made;
    made.scale = kernel_scale(made.bounds);
    if (made.scale != 1)
        for (BuildItem<float>& item : made.items) {
            item.lower = item.lower * made.scale;
            item.upper = item.upper * made.scale;
        }
    return made;
}

} // namespace renderer
