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
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, SurfaceLanes::kHits>;
using V = hn::Vec<D>;

// The functions of vec3.h, lane by lane.
struct Vectors {
    V x, y, z;
};

HWY_INLINE V set(double value)
{
    return hn::Set(D(), value);
}
HWY_INLINE Vectors splat(Vec3d v)
{
    return {set(v.x), set(v.y), set(v.z)};
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
HWY_INLINE Vectors add(const Vectors& a, const Vectors& b)
{
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vectors subtract(const Vectors& a, const Vectors& b)
{
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vectors times(const Vectors& a, V s)
{
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE Vectors abs(const Vectors& v)
{
    return {hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z)};
}
HWY_INLINE V dot(const Vectors& a, const Vectors& b)
{
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vectors cross(const Vectors& a, const Vectors& b)
{
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Vectors divided(const Vectors& v, V by)
{
    return {hn::Div(v.x, by), hn::Div(v.y, by), hn::Div(v.z, by)};
}
HWY_INLINE Vectors normalize(const Vectors& v)
{
    const Vectors size = abs(v);
    const V xy = hn::IfThenElse(hn::Gt(size.x, size.y), size.x, size.y);
    const Vectors s = divided(v, hn::IfThenElse(hn::Gt(xy, size.z), xy, size.z));
    return divided(s, hn::Sqrt(dot(s, s)));
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
