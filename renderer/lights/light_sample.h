// illuminate: what a light of no size sends to a point: from where, how far, how much.
//
// Units   irradiance on a surface that faces the light, W/m^2; distances in metres, infinite for directional
//         lights.
// Source  point: inverse square law, I/d^2; spot: the smooth step between the cones of M. Pharr et al.,
//         "Physically Based Rendering", section 12.2.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/scene_description.h"
#include "renderer/math/vec3.h"

#include <cstdint>

namespace renderer {

enum class LightKind : std::uint8_t { point, spot, directional };

// A light made ready: directions unit, cones as cosines.
struct PreparedLight {
    LightKind kind = LightKind::point;
    Vec3d position{};
    Vec3d toward{}; // directional: towards the light; spot: the way it shines
    Rgb strength{}; // intensity, or irradiance of a directional light
    double cos_inner = 1, cos_outer = 1;
};

PreparedLight prepare_light(const Light& light);

struct LightSample {
    Vec3d wi{};          // unit, towards the light
    double distance = 0; // where a shadow ray must end
    Rgb irradiance{};    // black: nothing arrives, no shadow ray is needed
};

LightSample illuminate(const PreparedLight& light, Vec3d point);

} // namespace renderer
