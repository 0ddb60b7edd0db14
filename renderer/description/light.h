// Lights and environments, as a user wrote them.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/atmosphere.h"
#include "renderer/math/affine.h"

#include <cstdint>
#include <optional>
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
// A disk at infinity, of the same radiance everywhere.
struct SunLight {
    Vec3d direction{0, -1, 0};          // the way the light travels; any length but zero
    Rgb irradiance{1, 1, 1};            // W/m^2 on a surface that faces its centre
    double angular_radius_deg = 0.2665; // as the sun is seen from the earth
    friend bool operator==(const SunLight&, const SunLight&) = default;
};
// What an area light gives: one of the two.
struct AreaLight {
    Rgb radiance{1, 1, 1};    // W/(m^2 sr), the same in every direction
    std::optional<Rgb> power; // W in all, instead: from what faces the scene, all of a two-sided light
    bool two_sided = false;   // also from its back; a sphere has none
    Affine3 world_from_light;
    bool visible_to_camera = true;
    friend bool operator==(const AreaLight&, const AreaLight&) = default;
};
struct RectangleLight : AreaLight { // in the xy plane, centred, shining towards +z
    double width_m = 1, height_m = 1;
    friend bool operator==(const RectangleLight&, const RectangleLight&) = default;
};
struct DiskLight : AreaLight { // in the xy plane, centred, shining towards +z
    double radius_m = 0.5;
    friend bool operator==(const DiskLight&, const DiskLight&) = default;
};
struct SphereLight : AreaLight { // centred at the origin, shining outwards
    double radius_m = 0.5;
    friend bool operator==(const SphereLight&, const SphereLight&) = default;
};
using Light =
    std::variant<PointLight, SpotLight, DirectionalLight, SunLight, RectangleLight, DiskLight, SphereLight>;

struct NoEnvironment {
    friend bool operator==(const NoEnvironment&, const NoEnvironment&) = default;
};
struct ColorEnvironment {
    Rgb radiance{1, 1, 1}; // W/(m^2 sr), the same from everywhere
    friend bool operator==(const ColorEnvironment&, const ColorEnvironment&) = default;
};
struct ImageEnvironment {    // equirectangular: its centre column lies along -z, its top row at +y
    std::uint32_t image = 0; // index into SceneDescription::images
    double rotation_deg = 0; // about +y, counter-clockwise seen from above
    double scale = 1;        // of its numbers, to W/(m^2 sr)
    friend bool operator==(const ImageEnvironment&, const ImageEnvironment&) = default;
};
using Environment = std::variant<NoEnvironment, ColorEnvironment, ImageEnvironment, AtmosphereDescription>;

} // namespace renderer
