// improve_hit: the test that decides: one triangle of a block in double, drawn in to the best hit so far.
//
// Promise  a pure function of ray and triangle, the same for every kernel; the least (t, primitive) wins.
#pragma once

#include "renderer/accel/mesh_hit.h"
#include "renderer/accel/triangle_block.h"
#include "renderer/geometry/triangle.h"

namespace renderer {

// True where the triangle became the best hit; t in kernel units. No hit yet: t infinite, primitive kNone.
inline bool improve_hit(const WatertightRay<double>& ray,
                        double t_min,
                        double t_max,
                        const TriangleBlock& block,
                        unsigned lane,
                        MeshHit& best)
{
    const std::uint32_t primitive = block.primitive[lane];
    if (primitive == TriangleBlock::kNone) return false;
    const auto hit = intersect_watertight(
        ray, t_min, t_max, block.corner(0, lane), block.corner(1, lane), block.corner(2, lane));
    if (!hit || hit->t > best.t || (hit->t == best.t && primitive > best.primitive)) return false;
    best = {hit->t, primitive, hit->barycentrics};
    return true;
}

} // namespace renderer
