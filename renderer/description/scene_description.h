// SceneDescription: what a user wrote, complete and checked, in plain structs: the renderer's input.
//
// Everything is SI and linear Rec. 709; things refer to one another by index. Angles stay in degrees, under
// names that end in _deg, so that a scene written out again has the very numbers that were read. `api` fills
// and writes these structs; the defaults of scene.md are the member initialisers here and nowhere else.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/math/affine.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace renderer {

struct CameraDescription {
    Vec3d position{0, 0, 0};
    bool aim_is_direction = false; // `aim` is a direction (any length but zero) instead of a point
    Vec3d aim{0, 0, -1};
    Vec3d up{0, 1, 0};   // need not be perpendicular; parallel to the view is allowed
    double fov_deg = 45; // vertical, in (0, 180)

    friend bool operator==(const CameraDescription&, const CameraDescription&) = default;
};

struct DiffuseMaterial {
    Rgb color{0.5f, 0.5f, 0.5f};
    friend bool operator==(const DiffuseMaterial&, const DiffuseMaterial&) = default;
};

enum class PhongForm : std::uint8_t { classic, normalized };

struct PhongMaterial {
    Rgb diffuse{0.5f, 0.5f, 0.5f};
    Rgb specular{0.2f, 0.2f, 0.2f};
    double shininess = 32;
    Rgb ambient{0, 0, 0}; // radiance added whatever the light: the k_a i_a of the model, already multiplied
    PhongForm form = PhongForm::normalized;
    friend bool operator==(const PhongMaterial&, const PhongMaterial&) = default;
};

using Material = std::variant<DiffuseMaterial, PhongMaterial>;

struct NamedMaterial {
    std::string name;
    Material material;
    friend bool operator==(const NamedMaterial&, const NamedMaterial&) = default;
};

// A mesh by the name the scene gives it: an index into SceneDescription::meshes.
struct MeshShape {
    std::uint32_t mesh = 0;
    std::string part; // one named node of the mesh; empty: all of it
    friend bool operator==(const MeshShape&, const MeshShape&) = default;
};
struct RectangleShape { // in the xy plane, centred, facing +z
    double width_m = 1, height_m = 1;
    friend bool operator==(const RectangleShape&, const RectangleShape&) = default;
};
struct DiskShape { // in the xy plane, centred, facing +z
    double radius_m = 0.5;
    friend bool operator==(const DiskShape&, const DiskShape&) = default;
};
struct BoxShape { // centred at the origin
    Vec3d size_m{1, 1, 1};
    friend bool operator==(const BoxShape&, const BoxShape&) = default;
};
struct SphereShape { // centred at the origin, exact
    double radius_m = 0.5;
    friend bool operator==(const SphereShape&, const SphereShape&) = default;
};
using Shape = std::variant<MeshShape, RectangleShape, DiskShape, BoxShape, SphereShape>;

enum class Shading : std::uint8_t { automatic, smooth, flat }; // automatic: smooth where the mesh has normals

struct ObjectDescription {
    Shape shape;
    // Index into materials; nothing: the mesh's own, else the default diffuse.
    std::optional<std::uint32_t> material;
    Affine3 world_from_object;
    bool visible_to_camera = true;
    Shading shading = Shading::automatic;
    friend bool operator==(const ObjectDescription&, const ObjectDescription&) = default;
};

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

enum class TransportType : std::uint8_t { automatic, direct };

struct TransportDescription {
    TransportType type = TransportType::automatic;
    friend bool operator==(const TransportDescription&, const TransportDescription&) = default;
};

// A file that the scene names: resolved in the job's `files` to a digest.
struct MeshReference {
    std::string name;   // as the scene wrote it
    std::string digest; // "sha256:<64 hex>"; empty in a local render, where the name is a path
    friend bool operator==(const MeshReference&, const MeshReference&) = default;
};

struct SceneDescription {
    std::optional<CameraDescription> camera; // nothing: framed from the bounds, see plan/plan.h
    std::optional<Environment> environment;  // nothing: none, or assumed where nothing else shines
    std::vector<NamedMaterial> materials;
    std::vector<MeshReference> meshes; // each name once
    std::vector<ObjectDescription> objects;
    std::vector<Light> lights;
    TransportDescription transport;
    friend bool operator==(const SceneDescription&, const SceneDescription&) = default;
};

} // namespace renderer
