// CameraDescription: where the picture is seen from.
#pragma once

#include "renderer/math/vec3.h"

namespace renderer {

struct CameraDescription {
    Vec3d position{0, 0, 0};
    bool aim_is_direction = false; // `aim` is a direction (any length but zero) instead of a point
    Vec3d aim{0, 0, -1};
    Vec3d up{0, 1, 0};   // need not be perpendicular; parallel to the view is allowed
    double fov_deg = 45; // vertical, in (0, 180)

    friend bool operator==(const CameraDescription&, const CameraDescription&) = default;
};

} // namespace renderer
