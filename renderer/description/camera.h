// CameraDescription: where the picture is seen from, or where light is measured.
#pragma once

#include "renderer/math/vec3.h"

#include <cstdint>
#include <optional>

namespace renderer {

enum class Projection : std::uint8_t {
    perspective,
    orthographic,
    panorama, // equirectangular: all directions; the centre looks along the view
    meter     // no picture: what arrives at a point, as numbers
};

// What a meter tells: radiance along its direction, or irradiance on a surface that faces it.
enum class MeterQuantity : std::uint8_t { radiance, irradiance };

struct CameraDescription {
    Projection projection = Projection::perspective;
    Vec3d position{0, 0, 0};
    bool aim_is_direction = false; // `aim` is a direction (any length but zero) instead of a point
    Vec3d aim{0, 0, -1};
    Vec3d up{0, 1, 0}; // need not be perpendicular; parallel to the view is allowed

    double fov_deg = 45;      // perspective: vertical, in (0, 180)
    double lens_radius_m = 0; // perspective: of a thin lens; 0: a pinhole, everything sharp
    // Perspective, with a lens: along the view, to the plane that is sharp. Nothing: where it looks, a metre for a
    // direction.
    std::optional<double> focus_distance_m{};
    double height_m = 1; // orthographic: of what the picture shows
    MeterQuantity quantity = MeterQuantity::radiance;

    friend bool operator==(const CameraDescription&, const CameraDescription&) = default;
};

} // namespace renderer
