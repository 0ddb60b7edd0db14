// improve_hit: the test that decides: one triangle of a block in double, drawn in to the best hit so far.
//
// Promise  a pure function of ray and triangle, the same for every kernel; the least (t, primitive) wins.
#pragma once

#include "renderer/accel/mesh_hit.h"
#include "renderer/accel/mesh_kernels.h"
#include "renderer/accel/triangle_block.h"
#include "renderer/geometry/triangle.h"

namespace renderer {

// Apart, so that a mesh of floats does not pay for it.
[[gnu::noinline]] inline std::optional<TriangleHit<double>>
intersect_with_residuals(const WatertightRay<double>& ray,
                         double t_min,
                         double t_max,
                         const TriangleBlock& block,
                         const CornerResiduals& lacking,
                         unsigned lane)
{
    return intersect_watertight(ray,
                                t_min,
                                t_max,
                                block.corner(0, lane) + lacking.corner(0, lane),
                                block.corner(1, lane) + lacking.corner(1, lane),
                                block.corner(2, lane) + lacking.corner(2, lane));
}

// True where the triangle became the best hit; t in kernel units. No hit yet: t infinite, primitive kNone.
inline bool improve_hit(const WatertightRay<double>& ray,
                        double t_min,
                        double t_max,
                        const MeshView& mesh,
                        const TriangleBlock& block, // of the mesh
                        unsigned lane,
                        MeshHit& best)
{
    const std::uint32_t primitive = block.primitive[lane];
    if (primitive == TriangleBlock::kNone) return false;
    const auto hit =
        mesh.residuals == nullptr
            ? intersect_watertight(
                  ray, t_min, t_max, block.corner(0, lane), block.corner(1, lane), block.corner(2, lane))
            : intersect_with_residuals(ray, t_min, t_max, block, mesh.residuals[&block - mesh.leaves], lane);
    if (!hit || hit->t > best.t || (hit->t == best.t && primitive > best.primitive)) return false;
    best = {hit->t, primitive, hit->barycentrics};
    return true;
}

} // namespace renderer
