#include "renderer/accel/surface_kernels.h"

#include "renderer/geometry/rounding.h"
#include "renderer/math/kernel_targets.h"

#include <vector>

// This file is compiled once for every target of Highway; what is above, for the baseline alone.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/accel/surface_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "renderer/math/vec3_lanes-inl.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

using D = hn::CappedTag<double, SurfaceLanes::kHits>;
using V = hn::Vec<D>;
using Vectors = Vec3Lanes<V>;

HWY_INLINE V set(double value)
{
    return hn::Set(D(), value);
}
HWY_INLINE Vectors splat(Vec3d v)
{
    return splat(D(), v);
}
HWY_INLINE Vectors load(const SurfaceLanes::Vectors& from, std::size_t first)
{
    const D d;
    return {hn::Load(d, from[0] + first), hn::Load(d, from[1] + first), hn::Load(d, from[2] + first)};
}
HWY_INLINE void store(const Vectors& v, SurfaceLanes::Vectors& to, std::size_t first)
{
    const D d;
    hn::Store(v.x, d, to[0] + first);
    hn::Store(v.y, d, to[1] + first);
    hn::Store(v.z, d, to[2] + first);
}
// |M| v
HWY_INLINE Vectors reach(const Affine3& m, const Vectors& v)
{
    return {dot(abs(splat(m.rows[0])), v), dot(abs(splat(m.rows[1])), v), dot(abs(splat(m.rows[2])), v)};
}
HWY_INLINE Vectors transformed(const Affine3& m, const Vectors& p)
{
    const Vectors turned{dot(splat(m.rows[0]), p), dot(splat(m.rows[1]), p), dot(splat(m.rows[2]), p)};
    return add(turned, splat(m.translation));
}

HWY_INLINE void find(const Placement& placement, SurfaceLanes& lanes, std::size_t first)
{
    const Vectors a = load(lanes.corner[0], first), b = load(lanes.corner[1], first),
                  c = load(lanes.corner[2], first), weights = load(lanes.weights, first);
    const Vectors da = times(a, weights.x), db = times(b, weights.y), dc = times(c, weights.z);
    const Vectors position = add(add(da, db), dc);
    const Vectors error = times(add(add(abs(da), abs(db)), abs(dc)), set(gamma<double>(kWeighingRoundings)));
    const Vectors normal = normalize(cross(subtract(b, a), subtract(c, a)));
    store(position, lanes.object_position, first);
    if (placement.is_identity) {
        store(position, lanes.position, first);
        store(error, lanes.error, first);
        store(normal, lanes.normal, first);
        return;
    }
    const V placing = set(gamma<double>(kPlacingRoundings));
    const Affine3& there = placement.world_from_object;
    const Vectors world = transformed(there, position);
    const Vectors own = add(error, times(abs(position), placing));
    const Vectors moved = add(reach(there, own), times(abs(splat(there.translation)), placing));
    store(world, lanes.position, first);
    store(add(moved, transformed(placement.trip_error, abs(world))), lanes.error, first);
    const auto& rows = placement.object_from_world.rows;
    const Vectors turned = add(add(times(splat(rows[0]), normal.x), times(splat(rows[1]), normal.y)),
                               times(splat(rows[2]), normal.z));
    store(normalize(turned), lanes.normal, first);
}

void find_all(const Placement& placement, SurfaceLanes& lanes)
{
    for (std::size_t first = 0; first < SurfaceLanes::kHits; first += hn::MaxLanes(D()))
        find(placement, lanes, first);
}

} // namespace

FindSurfaces surface_finding()
{
    return find_all;
}

} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace renderer {

std::span<const FindSurfaces> all_find_surfaces()
{
    static const std::vector<FindSurfaces> usable = HELIOGRAPH_USABLE_KERNELS(FindSurfaces, surface_finding);
    return usable;
}

FindSurfaces find_surfaces()
{
    static const FindSurfaces best = all_find_surfaces().front();
    return best;
}

} // namespace renderer
#endif // HWY_ONCE
