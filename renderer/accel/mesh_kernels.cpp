#include "renderer/accel/mesh_kernels.h"

#include "renderer/accel/exact_ray.h"
#include "renderer/accel/exact_test.h"
#include "renderer/accel/ray_fan.h"
#include "renderer/accel/ray_run.h"
#include "renderer/math/kernel_targets.h"
#include "renderer/math/uninitialized.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

// This file is compiled once for every target of Highway; what is above, for the baseline alone. The order of
// the rest matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/accel/mesh_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "renderer/accel/enter_box-inl.h"
#include "renderer/accel/follow_apart-inl.h"
#include "renderer/accel/follow_fan-inl.h"
#include "renderer/accel/follow_together-inl.h"
#include "renderer/accel/shadow_fans-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// Rays one by one. Those that miss: no primitive.
template <bool kAnyHit>
void trace_apart(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits)
{
    LoneRays run;
    prepare_apart(run, mesh, rays, count);
    for (unsigned i = 0; i < count; ++i)
        hits[i] = {std::numeric_limits<double>::infinity(), TriangleBlock::kNone, {}};
    if (run.rays == 0) return;
    LoneWalk<kAnyHit>(mesh, run, rays, hits).walk();
    for (unsigned i = 0; i < count; ++i)
        hits[i].t *= run.ray_units[i];
}

std::uint64_t found(const MeshHit* hits, unsigned count)
{
    std::uint64_t found = 0;
    for (unsigned i = 0; i < count; ++i)
        found |= std::uint64_t{hits[i].primitive != TriangleBlock::kNone} << i;
    return found;
}

template <bool kAnyHit>
std::uint64_t trace_lone(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits)
{
    trace_apart<kAnyHit>(mesh, rays, count, hits);
    return found(hits, count);
}

template <bool kAnyHit>
void trace_many(const MeshView& mesh, const Ray* rays, std::size_t count, MeshHit* hits)
{
    for (std::size_t i = 0; i < count; i += LoneRays::kRays)
        trace_apart<kAnyHit>(mesh,
                             rays + i,
                             static_cast<unsigned>(std::min<std::size_t>(LoneRays::kRays, count - i)),
                             hits + i);
}

// A glance at a few rays of a run: false where they certainly do not run alike.
bool may_run_alike(const Ray* rays, unsigned count)
{
    if (count < 4) return false;
    const auto octant = [](const Ray& ray) {
        return unsigned{std::signbit(ray.direction.x)} | unsigned{std::signbit(ray.direction.y)} << 1 |
               unsigned{std::signbit(ray.direction.z)} << 2;
    };
    const unsigned first = octant(rays[0]);
    return octant(rays[count - 1]) == first && octant(rays[count / 2]) == first &&
           octant(rays[count / 3]) == first && octant(rays[1]) == first;
}

// Rays that may run alike.
template <bool kAnyHit>
std::uint64_t trace_alike(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits)
{
    RayRun run;
    const Following how = prepare_run(run, mesh, rays, count);
    if (how == Following::none) return 0;
    if (how == Following::apart) {
        return trace_lone<kAnyHit>(mesh, rays, count, hits);
    }
    for (unsigned i = 0; i < count; ++i)
        hits[i] = {std::numeric_limits<double>::infinity(), TriangleBlock::kNone, {}};
    PacketWalk<kAnyHit>(mesh, run, hits).walk();
    for (unsigned i = 0; i < count; ++i)
        hits[i].t *= run.ray_units[i];
    return found(hits, count);
}

// False: no fan, and nothing is told.
template <bool kAnyHit>
bool trace_fan(
    const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits, std::uint64_t& found_in_fan);

template <>
bool trace_fan<false>(
    const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits, std::uint64_t& found_in_fan)
{
    RayFan fan;
    if (!prepare_fan(fan, mesh, rays, count, false)) return false;
    FanWalk<false> walk(mesh, fan, rays, hits);
    found_in_fan = walk.walk();
    // Rays that meet next to nothing in any case say nothing of the nearest hit's cost.
    if (mesh.fans != nullptr && walk.met_many()) mesh.fans->nearest.tell(!walk.gave_up());
    // Rays that stand far apart among small triangles.
    if (walk.gave_up()) found_in_fan = trace_lone<false>(mesh, rays, count, hits);
    return true;
}

template <>
bool trace_fan<true>(
    const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits, std::uint64_t& found_in_fan)
{
    ShadowFans fans(mesh, rays, count, hits);
    if (!fans.follow()) return false;
    if (const std::span<const Ray> left = fans.left(); !left.empty())
        fans.found_of_left(trace_lone<true>(mesh, left.data(), static_cast<unsigned>(left.size()), hits));
    found_in_fan = fans.found();
    return true;
}

// Run by run; runs that do not run alike wait for their neighbours, so that more are in flight at once.
template <bool kAnyHit>
std::uint64_t trace_runs(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits)
{
    std::uint64_t met = 0;
    unsigned apart = 0; // rays before `first` that wait
    const auto trace_waiting = [&](unsigned first) HWY_ATTR {
        if (apart == 0) return;
        const unsigned from = first - apart;
        met |= trace_lone<kAnyHit>(mesh, rays + from, apart, hits + from) << from;
        apart = 0;
    };
    for (unsigned first = 0; first < count; first += RayRun::kRays) {
        const unsigned some = std::min(RayRun::kRays, count - first);
        std::uint64_t in_run = 0;
        const bool as_fan =
            some != count && trace_fan<kAnyHit>(mesh, rays + first, some, hits + first, in_run);
        // Shadow rays to a light that has a size are quicker apart.
        const bool spread = kAnyHit && some > 1 && !(rays[first].direction == rays[first + 1].direction);
        if (!as_fan && (spread || !may_run_alike(rays + first, some))) {
            apart += some;
            continue;
        }
        trace_waiting(first);
        if (!as_fan) in_run = trace_alike<kAnyHit>(mesh, rays + first, some, hits + first);
        met |= in_run << first;
    }
    trace_waiting(count);
    return met;
}

// All as one fan, or run by run, or apart where that has been quicker.
template <bool kAnyHit>
std::uint64_t trace(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits)
{
    if (mesh.nodes == nullptr) return 0;
    if (mesh.fans != nullptr && !mesh.fans->of(kAnyHit).worth_trying(rays[0]))
        return trace_lone<kAnyHit>(mesh, rays, count, hits);
    std::uint64_t met = 0;
    if (trace_fan<kAnyHit>(mesh, rays, count, hits, met)) return met;
    return trace_runs<kAnyHit>(mesh, rays, count, hits);
}

bool closest_hit(const MeshView& mesh, const Ray& ray, MeshHit& hit)
{
    MeshHit found;
    if (mesh.nodes == nullptr) return false;
    trace_apart<false>(mesh, &ray, 1, &found);
    if (found.primitive == TriangleBlock::kNone) return false;
    hit = found;
    return true;
}

bool any_hit(const MeshView& mesh, const Ray& ray)
{
    MeshHit hit;
    if (mesh.nodes == nullptr) return false;
    trace_apart<true>(mesh, &ray, 1, &hit);
    return hit.primitive != TriangleBlock::kNone;
}

std::uint64_t closest_hits(const MeshView& mesh, const Ray* rays, unsigned count, MeshHit* hits)
{
    return trace<false>(mesh, rays, count, hits);
}

std::uint64_t any_hits(const MeshView& mesh, const Ray* rays, unsigned count)
{
    // Every way writes before it reads, and fans do not write at all.
    alignas(MeshHit) std::byte hits[MeshKernels::kMostRays * sizeof(MeshHit)];
    return trace<true>(mesh, rays, count, reinterpret_cast<MeshHit*>(hits));
}

} // namespace

MeshKernels kernels()
{
    return {hwy::TargetName(HWY_TARGET),
            closest_hit,
            any_hit,
            closest_hits,
            any_hits,
            trace_many<false>,
            trace_many<true>,
            enter_box};
}

} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace renderer {

std::span<const MeshKernels> all_mesh_kernels()
{
    static const std::vector<MeshKernels> usable = HELIOGRAPH_USABLE_KERNELS(MeshKernels, kernels);
    return usable;
}

const MeshKernels& mesh_kernels()
{
    static const MeshKernels best = all_mesh_kernels().front();
    return best;
}

} // namespace renderer
#endif // HWY_ONCE
