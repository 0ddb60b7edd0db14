// Emitter: a surface that shines: triangle, parallelogram, disk, sphere or ellipsoid. sample_emitter.h draws from it.
//
// Frame   that of the scene which is traced; points and vectors in double.
// Units   radiance W/(m^2 sr), the same in every direction from the shining side.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/math/affine.h"
#include "renderer/math/bounds.h"
#include "renderer/math/vec3.h"

#include <cstdint>
#include <optional>

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
