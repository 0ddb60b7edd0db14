// Plan: what a scene needs, decided once from the description and the meshes' facts, and explained.
//
// The only place where "model only what the scene requires" is decided. It also predicts cost, so that a job
// over a limit is refused with the number before anything is allocated.
#pragma once

#include "renderer/description/fault.h"
#include "renderer/description/limits.h"
#include "renderer/description/report.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/geometry/mesh.h"

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace renderer {

// What the plan must know of a mesh; cheap to take from an imported one.
struct MeshFacts {
    Bounds3f bounds;
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    bool has_normals = false;
    bool has_materials = false;
    bool has_textures = false;
    bool has_specular = false; // a material of its own shines: it is shaded as normalised Phong
    std::vector<MeshPart> parts;
    std::vector<Bounds3f> part_bounds; // one a part
};
MeshFacts facts_of(const Mesh& mesh);

// The description with everything filled in that it left open: camera, environment, lights.
// What was assumed is told as ModelChoice ("assumed_camera", "assumed_sky", "assumed_sun").
struct AssumedScene {
    SceneDescription description; // camera and environment are engaged
    std::vector<ModelChoice> assumed;
};
AssumedScene assume_defaults(SceneDescription description, std::span<const MeshFacts> meshes, double aspect);

struct Plan {
    TransportType transport = TransportType::direct;
    ModelReport models;
    bool keep_normals = false;      // some object shades smoothly
    bool two_levels = true;         // false: one untransformed mesh needs no top-level BVH
    std::uint64_t camera_rays = 0;  // predicted, for `samples` settings
    std::uint64_t shadow_rays = 0;  // upper bound
    std::uint64_t memory_bytes = 0; // film, pictures, meshes, BVHs: upper bound
};

// Either a plan or every fault: a part that no mesh has, a singular transform, a budget exceeded (with the
// number). `scene` has been through assume_defaults.
std::variant<Plan, std::vector<Fault>> make_plan(const AssumedScene& scene,
                                                 std::span<const MeshFacts> meshes,
                                                 const RenderSettings& settings,
                                                 const Limits& limits);

} // namespace renderer
