// improve_hit: the test that decides: one triangle of a block in double, drawn in to the best hit so far.
//
// Promise  a pure function of ray and triangle, the same for every kernel; the least (t, primitive) wins.
#pragma once

#include "renderer/accel/mesh_hit.h"
#include "renderer/accel/mesh_kernels.h"
#include "renderer/accel/triangle_block.h"
#include "renderer/geometry/triangle.h"

namespace renderer {

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
    Vec3d a = block.corner(0, lane), b = block.corner(1, lane), c = block.corner(2, lane);
    if (mesh.residuals != nullptr) {
        const CornerResiduals& lacking = mesh.residuals[&block - mesh.leaves];
        a = a + lacking.corner(0, lane);
        b = b + lacking.corner(1, lane);
        c = c + lacking.corner(2, lane);
    }
    const auto hit = intersect_watertight(ray, t_min, t_max, a, b, c);
    if (!hit || hit->t > best.t || (hit->t == best.t && primitive > best.primitive)) return false;
    best = {hit->t, primitive, hit->barycentrics};
    return true;
}

} // namespace renderer
