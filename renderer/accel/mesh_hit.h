// MeshHit: where a ray met a mesh, in its object space.
#pragma once

#include "renderer/geometry/mesh.h"
#include "renderer/geometry/surface_point.h"
#include "renderer/math/vec3.h"

#include <cstdint>

namespace renderer {

struct MeshHit {
    double t = 0;
    std::uint32_t primitive = 0; // triangle, counted over the whole mesh also where a run was prepared
    Vec3d barycentrics;          // weights of its three corners
};

// Position, error bound and normal of a hit, in object space.
inline SurfacePoint surface_point(const Mesh& mesh, const MeshHit& hit)
{
    const Triangle& v = mesh.triangles[hit.primitive];
    return triangle_point(mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2]), hit.barycentrics);
}

} // namespace renderer
