// Warps: turn uniform random numbers into directions.
//
// Every warp comes as a pair: sample_X(u) draws, pdf_X(v) answers "how likely was v?". The pair must agree:
// warp_test.cpp checks each one with a chi-square test.
//
// Units   u in [0,1)^2; directions are unit length, z up; pdfs are per steradian.
// Source  P. Shirley, K. Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997; the power
//         lobe: E. Lafortune, Y. Willems, "Using the Modified Phong Reflectance Model for Physically Based
//         Rendering", 1994.
// Cost    O(1), no allocation, no locks, never throws.
#pragma once

#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

#include <utility>

namespace renderer {

// A point of the unit disk, uniformly.
struct DiskPoint {
    double x, y;
};
DiskPoint concentric_disk(Sample2 u);

// Draws a direction with density proportional to its cosine with +z.
Vec3f sample_cosine_hemisphere(Sample2 u);
// cos(theta)/pi, and 0 below the horizon.
float pdf_cosine_hemisphere(float cos_theta);

// Draws a direction around +z with density proportional to cos(theta)^exponent, exponent >= 0.
Vec3f sample_power_lobe(Sample2 u, double exponent);

// cos^exponent from 1 - cos, so that lobes of exponent 1e6 keep their digits; one_minus_cos in [0, 1], 0^0
// = 1.
double power_of_cosine(double one_minus_cos, double exponent);

// (exponent + 1) / (2 pi) cos^exponent, and 0 below the horizon.
double pdf_power_lobe(double one_minus_cos, double exponent);

// An orthonormal frame around a unit normal; the same normal gives the same frame.
// Source  T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
struct Frame {
    Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    Frame() = default; // the world's own
    explicit Frame(Vec3f normal);
    Vec3f to_world(Vec3f v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3f to_local(Vec3f v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
};

// The same around a unit vector in double: x and y of it.
std::pair<Vec3d, Vec3d> basis_around(Vec3d z);

} // namespace renderer
