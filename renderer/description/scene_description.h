// SceneDescription: what a user wrote, complete and checked, in plain structs: the renderer's input.
//
// Everything is SI and linear Rec. 709; things refer to one another by index. Angles stay in degrees, under
// names that end in _deg, so that a scene written out again has the very numbers that were read. `api` fills
// and writes these structs; the defaults of scene.md are the member initialisers here and nowhere else.
#pragma once

#include "renderer/description/camera.h"
#include "renderer/description/light.h"
#include "renderer/description/material.h"
#include "renderer/description/transport.h"
#include "renderer/math/affine.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace renderer {

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

// A file that the scene names: resolved in the job's `files` to a digest.
struct MeshReference {
    std::string name;   // as the scene wrote it
    std::string digest; // "sha256:<64 hex>"; empty in a local render, where the name is a path
    friend bool operator==(const MeshReference&, const MeshReference&) = default;
};

// A picture that materials or the environment name, resolved likewise.
struct ImageReference {
    std::string name;
    std::string digest;
    std::string pointer; // to the member that names it first: what faults of the picture are told with
    friend bool operator==(const ImageReference&, const ImageReference&) = default;
};

struct SceneDescription {
    std::optional<CameraDescription> camera; // nothing: framed from the bounds, see plan/plan.h
    std::optional<Environment> environment;  // nothing: none, or assumed where nothing else shines
    std::vector<NamedMaterial> materials;
    std::vector<MeshReference> meshes;  // each name once
    std::vector<ImageReference> images; // each name once
    std::vector<ObjectDescription> objects;
    std::vector<Light> lights;
    TransportDescription transport;
    friend bool operator==(const SceneDescription&, const SceneDescription&) = default;
};

} // namespace renderer
