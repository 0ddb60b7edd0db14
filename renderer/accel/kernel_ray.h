// KernelRay: a ray as the triangle kernels see it: exact in double, and a float copy that says how far off it
// may be.
//
// Frame    the mesh's coordinates times a power of two, so that products of coordinates stay within float's
//          range; the direction is brought to a length near 1 by a power of two as well, so t counts in units
//          of the kernel.
// Promise  whatever the double test can hit, the float copy meets when boxes and triangles are taken larger
//          by `lateral`.
#pragma once

#include "renderer/accel/triangle_block.h"
#include "renderer/geometry/box.h"
#include "renderer/geometry/ray.h"
#include "renderer/geometry/triangle.h"
#include "renderer/math/bounds.h"

namespace renderer {

struct KernelRay {
    WatertightRay<double> exact;
    Vec3d direction;
    double t_min = 0, t_max = 0; // kernel units
    double ray_units = 1;        // t of the ray = t of the kernel * ray_units
    // The float copy starts at `start` (kernel units), where the double ray enters the mesh's bounds.
    double start = 0;
    Vec3f origin;
    float sx = 0, sy = 0, sz = 0;
    float lateral = 0; // how far to the side of the double ray anything computed from the float copy may be
    SlabRay<float> slabs;

    // The double part. False: the ray is not traceable.
    bool prepare_exact(const Ray& ray, float scale);
    // Both parts. False: the ray also may miss the box.
    bool prepare(const Ray& ray, const Bounds3f& box, float scale);

    float begin() const { return -4 * lateral; }
    // Where boxes and triangles may be left out, once a hit at t (kernel units) is known.
    float end_for(double t) const;
    // Lanes of the block that the double test might accept up to `end`; the others it would reject for
    // certain.
    unsigned may_hit(const TriangleBlock& block, float end) const;
};

// The power of two by which coordinates are to be multiplied; 1 where their size is moderate.
float kernel_scale(const Bounds3f& box);

} // namespace renderer
