// Where on a picture a point of a surface lies, and how that changes along the surface.
//
// Frame   u to the right and v upwards. A mesh has its own. Rectangle and each face of a box: the whole of
//         [0, 1]^2, seen from outside the right way round. Disk: the square around it. Sphere: u is 1/2 where z is
//         largest and grows towards +x, v goes from 0 at -y to 1 at +y in proportion to the angle: a picture of a
//         whole globe.
// Units   gradients per metre, in the world's frame, within the surface.
#pragma once

#include "renderer/accel/instance.h"
#include "renderer/textures/texture.h"

#include <optional>

namespace renderer {

struct SurfaceCoordinates {
    TexturePoint uv;
    Vec3d u_gradient,
        v_gradient; // zero where they are not known: at a pole, in a triangle without extent in uv
};

// Nothing where the mesh has none.
std::optional<SurfaceCoordinates> coordinates_at(const SceneHit& hit, const Instance& instance);

// What a cone of rays, `width` across where it meets the surface, covers of it: an ellipse, longer the more the
// surface turns away. `toward_viewer` is unit.
TextureFootprint footprint_of(const SurfaceCoordinates& at, Vec3d normal, Vec3d toward_viewer, double width);

// `normal`, tilted as the numbers of a normal map say: `tilt` is right, up, out in the picture's own frame. The
// normal itself where that frame is not known.
Vec3d tilted_normal(const SurfaceCoordinates& at, Vec3d normal, Vec3d tilt);

} // namespace renderer
