// Lights and environments, as a user wrote them.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/math/vec3.h"

#include <variant>

namespace renderer {

struct PointLight {
    Vec3d position{};
    Rgb intensity{1, 1, 1}; // W/sr
    friend bool operator==(const PointLight&, const PointLight&) = default;
};
struct SpotLight {
    Vec3d position{};
    Vec3d direction{0, -1, 0}; // the way the light travels; any length but zero
    Rgb intensity{1, 1, 1};    // W/sr within the inner cone
    double inner_deg = 20;     // half angles; full intensity inside inner, none beyond outer, smooth between
    double outer_deg = 30;
    friend bool operator==(const SpotLight&, const SpotLight&) = default;
};
struct DirectionalLight {
    Vec3d direction{0, -1, 0}; // the way the light travels; any length but zero
    Rgb irradiance{1, 1, 1};   // W/m^2 on a surface that faces it
    friend bool operator==(const DirectionalLight&, const DirectionalLight&) = default;
};
using Light = std::variant<PointLight, SpotLight, DirectionalLight>;

struct NoEnvironment {
    friend bool operator==(const NoEnvironment&, const NoEnvironment&) = default;
};
struct ColorEnvironment {
    Rgb radiance{1, 1, 1}; // W/(m^2 sr), the same from everywhere
    friend bool operator==(const ColorEnvironment&, const ColorEnvironment&) = default;
};
using Environment = std::variant<NoEnvironment, ColorEnvironment>;

} // namespace renderer
