// Plan: what a scene needs, decided once from the description and the meshes' facts, and explained.
//
// The only place where "model only what the scene requires" is decided. It also estimates the memory (budget.h),
// so that a job over a limit is refused with the number before its film and the trees of its parts are made.
#pragma once

#include "renderer/description/fault.h"
#include "renderer/description/limits.h"
#include "renderer/description/report.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/geometry/mesh.h"
#include "renderer/textures/image.h"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace renderer {

// A named part of a mesh: its run of triangles, and the box around them.
struct PartFacts {
    std::uint32_t first_triangle = 0, triangle_count = 0;
    Bounds3d bounds{};
};

// What the plan must know of a mesh; cheap to take from an imported one. Bounds are in the file's coordinates.
struct MeshFacts {
    Bounds3d bounds;
    Vec3d origin{};             // of the frame that the mesh is kept in; zero: the file's
    bool has_residuals = false; // its corners are more than floats
    bool is_shared = false;     // kept whole for other scenes, whatever this one asks of it: see mesh_use.h
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;
    bool has_normals = false;
    bool has_materials = false;
    bool has_textures = false;
    bool has_uvs = false;
    bool has_specular = false;     // a material of its own shines: it is shaded as normalised Phong
    std::uint64_t image_bytes = 0; // of the pictures that came with it, decoded
    std::uint32_t images = 0;
    std::uint32_t cutouts = 0;       // materials with holes by alpha
    std::uint32_t normal_mapped = 0; // materials with normal maps
    // Materials that some triangle has, by what of theirs is not modelled.
    std::uint32_t emissive_materials = 0, transparent_materials = 0, metal_materials = 0, rough_materials = 0;
    std::uint32_t physical_materials = 0;                         // glTF's, shaded as Cook-Torrance
    std::uint32_t glass_materials = 0, rough_glass_materials = 0; // closed bodies of glass; of these, rough
    bool is_all_glass = false;
    std::uint32_t shining_materials = 0;    // of the mesh's own that some triangle has
    std::uint64_t shining_triangles = 0;    // that have one of those
    std::map<std::string, PartFacts> parts; // by name; of several of one name, the first
};
MeshFacts facts_of(const Mesh& mesh);

// The same of a picture of the scene's.
struct ImageFacts {
    std::uint32_t width = 0, height = 0;
    std::uint64_t bytes = 0; // decoded
    bool has_alpha = false;
    bool is_real = false; // floats: light, not codes
};
ImageFacts facts_of(const Image& image);

// The description with everything filled in that it left open: camera, environment, lights.
// What was assumed is told as ModelChoice ("assumed_camera", "assumed_sky", "assumed_sun").
struct AssumedScene {
    SceneDescription description; // camera and environment are engaged
    std::vector<ModelChoice> assumed;
};
AssumedScene assume_defaults(SceneDescription description, std::span<const MeshFacts> meshes, double aspect);

// How radiance is found. `direct` is the short way for scenes that need no other; direct transport of others is a
// path of one scattering.
enum class Integrator : std::uint8_t { direct, whitted, path, ambient_occlusion, normals };

// The others look at shapes alone.
constexpr bool is_lit(Integrator integrator)
{
    return integrator != Integrator::ambient_occlusion && integrator != Integrator::normals;
}

// Of an atmosphere: which tables, and how exact.
struct SkyPlan {
    SkyMode mode = SkyMode::fast; // never automatic
    double far_m = 0;       // how far things are seen through the air; 0: the air before them does not count
    double table_error = 0; // that the table of the sky is to come to: rms over mean
};

// Small objects, and lights with a shape, whose triangles are traced as one mesh: see joined_objects.h.
struct JoinedObjects {
    std::vector<bool> objects, lights; // one each of the description's
    std::size_t count = 0;
    std::uint64_t triangles = 0;
};

struct Plan {
    Integrator integrator = Integrator::direct;
    std::uint32_t max_depth = 1; // scatterings, see description/transport.h
    float clamp = std::numeric_limits<float>::infinity();
    bool picks_lights = false; // by a tree, one a point; else each is asked
    Vec3d world_origin{};      // of the frame that is traced in, in the world: see world_frame.h
    JoinedObjects joined;
    std::vector<MeshTree> mesh_trees; // of each mesh, to be prepared with; its parts have plain ones
    std::optional<SkyPlan> sky;       // where the environment is an atmosphere
    double exposure_ev = 0;           // of a picture
    LayerSet layers{};                // to keep beside it
    std::string precision;            // of the meshes' corners: "float", "double" or "mixed"
    ModelReport models;
    Prediction prediction;
};

// Either a plan or every fault: a part that no mesh has, a singular transform, a budget exceeded (with the
// number). `scene` has been through assume_defaults.
std::variant<Plan, std::vector<Fault>> make_plan(const AssumedScene& scene,
                                                 std::span<const MeshFacts> meshes,
                                                 const RenderSettings& settings,
                                                 const Limits& limits,
                                                 std::span<const ImageFacts> images = {});

} // namespace renderer
