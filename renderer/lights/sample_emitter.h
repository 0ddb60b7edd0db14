// Directions to emitters, drawn from a point, and how likely they were.
//
// Units   densities per steradian, seen from the point.
// Promise sample() draws only directions in which the emitter's shining side is seen from the point, if nothing
//         else were there, and pdf() is the density of what it draws. A point in the emitter's own plane is not
//         lit.
// Source  rectangles: C. Urena et al., "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013;
//         spheres: the cone of directions, P. Shirley et al., "Monte Carlo Techniques for Direct Lighting
//         Calculations", ACM TOG 15(1), 1996; triangles: J. Arvo, "Stratified Sampling of Spherical Triangles",
//         SIGGRAPH 1995. What is sheared, disks, ellipsoids, and what is small as seen from the point, by area.
// Cost    some 100 operations; no allocation, no virtual call.
#pragma once

#include "renderer/lights/emitter.h"
#include "renderer/sampling/sampler.h"

#include <span>

namespace renderer {

struct EmitterSample {
    Vec3d wi{};          // unit, towards the emitter
    double distance = 0; // to it; 0: nothing was drawn
    double pdf = 0;
};
EmitterSample sample(const Emitter& emitter, Vec3d point, Sample2 u);
// The same for many points, to the bit: out[i] of points[i] and u[i]. Of rectangles several are drawn side by side.
void sample_many(const Emitter& emitter,
                 std::span<const Vec3d> points,
                 std::span<const Sample2> u,
                 std::span<EmitterSample> out);
// Density of the direction in which a ray from `point` met the emitter at `hit`.
double pdf(const Emitter& emitter, Vec3d point, Vec3d hit);

} // namespace renderer
