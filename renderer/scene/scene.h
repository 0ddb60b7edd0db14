// Scene: everything rays need, immutable and shared: instances over prepared meshes, materials, lights,
// camera.
//
// prepare() is the only way to get one; the description has been through assume_defaults and make_plan.
//
// Frame    the world's, in double, its origin moved to the plan's (plan/world_frame.h); surfaces are turned so that their normals face the viewer.
// Threads  immutable: any number of threads may trace it.
// Memory   holds its prepared meshes by shared ownership; they are the same ones that a cache holds.
#pragma once

#include "renderer/accel/instance_tree.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/camera/camera.h"
#include "renderer/description/report.h"
#include "renderer/description/scene_description.h"
#include "renderer/lights/light_sample.h"
#include "renderer/materials/bsdf.h"
#include "renderer/plan/plan.h"
#include "renderer/sampling/warp.h"

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

namespace renderer {

// What a camera ray found, ready to be shaded.
struct Surface {
    SurfacePoint point; // where shadow rays leave from
    Vec3f geometric;    // unit normals, both on the viewer's side of the surface
    Frame shading;
    const Bsdf* bsdf = nullptr;
};

class Scene {
public:
    // The parts of a scene, as prepare() has made them.
    struct Parts {
        Camera camera;
        InstanceTree tree;
        std::vector<PreparedLight> lights;
        Rgb environment; // black: none
        std::vector<Bsdf> bsdfs;
        std::vector<std::shared_ptr<const PreparedMesh>> meshes; // kept alive
        GeometryReport geometry;
        NumericsReport numerics;
        // How to shade an instance: one entry an object, in their order.
        struct Look {
            std::uint32_t first_bsdf = 0;       // with a material for each of the mesh's: the first of them
            const Mesh* materials_of = nullptr; // the mesh whose triangles choose their bsdf; or none
            const Mesh* normals_of = nullptr;   // the mesh whose normals are interpolated; or none: flat
        };
        std::vector<Look> looks;
    };
    explicit Scene(Parts parts) : parts_(std::move(parts)) {}

    const Camera& camera() const { return parts_.camera; }
    const InstanceTree& tree() const { return parts_.tree; }
    std::span<const PreparedLight> lights() const { return parts_.lights; }
    Rgb environment() const { return parts_.environment; }
    const GeometryReport& geometry() const { return parts_.geometry; }
    const NumericsReport& numerics() const { return parts_.numerics; }

    // `toward_viewer` points away from the surface, any length but zero.
    Surface surface_at(const SceneHit& hit, Vec3d toward_viewer) const;

private:
    Vec3d shading_normal(const SceneHit& hit, const Mesh& mesh) const;

    Parts parts_;
};

// meshes[i] is the prepared form of description.meshes[i]; `plan` is make_plan's for this very scene, so that
// nothing is checked again. Builds the trees of the parts that objects name: nullptr only if `stop` was
// requested meanwhile.
std::shared_ptr<const Scene> prepare(const AssumedScene& scene,
                                     const Plan& plan,
                                     std::span<const std::shared_ptr<const PreparedMesh>> meshes,
                                     const RenderSettings& settings,
                                     ThreadPool& pool,
                                     const std::stop_token& stop = {});

} // namespace renderer
