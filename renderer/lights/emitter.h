// Emitter: a surface that shines, to be sampled from a point: triangle, parallelogram, disk or sphere.
//
// Frame   that of the scene which is traced; points and vectors in double.
// Units   radiance W/(m^2 sr), the same in every direction from the shining side; densities per steradian, seen
//         from the point.
// Promise sample() draws only directions in which the emitter's shining side is seen from the point, if nothing
//         else were there, and pdf() is the density of what it draws. A point in the emitter's own plane is not
//         lit.
// Source  rectangles: C. Urena et al., "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013;
//         spheres: the cone of directions, P. Shirley et al., "Monte Carlo Techniques for Direct Lighting
//         Calculations", ACM TOG 15(1), 1996; triangles: J. Arvo, "Stratified Sampling of Spherical Triangles",
//         SIGGRAPH 1995. What is sheared, disks, ellipsoids, and what is small as seen from the point, by area.
// Cost    some 100 operations; no allocation, no virtual call.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/math/affine.h"
#include "renderer/math/bounds.h"
#include "renderer/math/vec3.h"
#include "renderer/sampling/sampler.h"

#include <cstdint>
#include <optional>
#include <span>

namespace renderer {

enum class EmitterShape : std::uint8_t { triangle, parallelogram, disk, sphere, ellipsoid };

struct Emitter {
    EmitterShape shape = EmitterShape::triangle;
    bool two_sided = false;
    Vec3d corner{};            // of a triangle or parallelogram; the centre of the others
    Vec3d side_u{}, side_v{};  // from the corner, or half axes of disk and ellipsoid
    Vec3d side_w{};            // third half axis of an ellipsoid; of a rectangle side_u as a unit vector
    double radius = 0;         // of a sphere
    Vec3d normal{};            // unit, of the shining side of what is flat
    double area = 0;           // m^2, of one side
    bool is_rectangle = false; // a parallelogram of right angles
    Rgb radiance{};
};

// Nothing where there is no area. The normal of a flat one is that of its object's +z, or of the triangle's winding,
// also when mirrored.
std::optional<Emitter> triangle_emitter(Vec3d a, Vec3d b, Vec3d c, Rgb radiance, bool two_sided);
std::optional<Emitter> rectangle_emitter(const Affine3& world_from_unit, Rgb radiance, bool two_sided);
std::optional<Emitter>
disk_emitter(const Affine3& world_from_disk, double radius, Rgb radiance, bool two_sided);
std::optional<Emitter>
sphere_emitter(const Affine3& world_from_sphere, double radius, Rgb radiance, bool two_sided);

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

// Whether light leaves it towards `direction` from where its outward unit normal is `normal`.
inline bool shines_towards(const Emitter& emitter, Vec3d normal, Vec3d direction)
{
    return emitter.two_sided || dot(normal, direction) > 0;
}

Bounds3d bounds_of(const Emitter& emitter);
// W, strongest channel: what it gives in all.
double power_of(const Emitter& emitter);
// The radiance with which it gives `power` W in all.
Rgb radiance_of_power(Rgb power, const Emitter& emitter);

} // namespace renderer
