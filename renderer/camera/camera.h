// Camera: the pinhole: from a point of the picture to the direction that is seen there.
//
// Units   picture points in pixels of the full picture, x to the right and y down from its top left corner,
//         so that pixel (i, j) is [i, i+1) x [j, j+1) and its centre (i + 0.5, j + 0.5); directions are unit
//         vectors.
// Frame   world, in double: a field of view of 0.01 degrees and an eye 1e8 m off keep their digits.
// Source  the pinhole of M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", section 6.2; the
//         vertical field of view is the named one, and the aspect ratio acts on x.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/math/vec3.h"

#include <cstdint>

namespace renderer {

class Camera {
public:
    // A description that check_description passed; width and height of the full picture, at least 1.
    Camera(const CameraDescription& description, std::uint32_t width_px, std::uint32_t height_px);

    Vec3d position() const { return position_; }
    Vec3d forward() const { return forward_; }
    Vec3d right() const { return right_; }
    Vec3d up() const { return up_; }

    // The centre of the picture gives forward(), to the bit.
    Vec3d direction(double picture_x, double picture_y) const;

private:
    Vec3d position_, forward_, right_, up_;
    double width_, height_;
    double tan_x_, tan_y_; // of half the field of view
};

} // namespace renderer
