// Ray sets: the same rays for every engine, cast on one mesh.
//
// primary 1024 x 1024 from a camera, in Morton order. shadow from each primary hit to a point light; they end
// at the light. diffuse a cosine-weighted bounce off each primary hit, shuffled; and once more in pixel
// order.
// Frame   the mesh's own coordinates. Origins stand off by 1e-5 of the diagonal, so that every engine answers
//         the same question; directions and origins are floats.
#pragma once

#include "renderer/accel/mesh_bvh.h"
#include "renderer/geometry/mesh.h"

#include <string>
#include <vector>

namespace bench {

struct FloatRay {
    renderer::Vec3f origin;
    float t_min;
    renderer::Vec3f direction;
    float t_max;
};

struct View {
    renderer::Vec3d eye, at, up{0, 1, 0}, light;
    double fov_deg = 40;
};

// Of a single object: all of it, seen from one side, the light to the other.
View view_of_object(const renderer::Bounds3f& bounds);
// Along the nave of Sponza, which the museum stands in.
View view_of_nave();
View scaled(const View& view, double factor);

struct RaySet {
    std::string name;
    bool occlusion; // any hit will do
    bool coherent;
    std::vector<FloatRay> rays;
};

// `bvh` only serves to find the primary hits.
std::vector<RaySet> make_ray_sets(const renderer::Mesh& mesh, const renderer::MeshBvh& bvh, const View& view);

} // namespace bench
