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
#include "renderer/lights/environment_map.h"
#include "renderer/materials/bsdf.h"
#include "renderer/materials/media.h"
#include "renderer/plan/plan.h"
#include "renderer/sampling/warp.h"
#include "renderer/scene/scene_caches.h"
#include "renderer/scene/scene_lights.h"
#include "renderer/scene/surface_textures.h"
#include "renderer/sky/sky_light.h"

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

namespace renderer {

// What a camera ray found, ready to be shaded.
struct Surface {
    SurfacePoint point;     // where shadow rays leave from
    Vec3f geometric;        // unit normals, all on the viewer's side of the surface
    Vec3d normal;           // the shading one
    Frame shading;          // around it
    bool is_outside = true; // the viewer is where the shape's own normal points
    const Bsdf* bsdf = nullptr;
};

// Where a textured material is made at a hit: a Surface may point into it. Nothing until then.
struct BsdfRoom {
    alignas(Bsdf) std::byte bytes[sizeof(Bsdf)];
};

class Scene {
public:
    // The parts of a scene, as prepare() has made them.
    struct Parts {
        Camera camera;
        InstanceTree tree;
        SceneLights lights;
        Rgb environment;                                       // of one colour; black: none
        std::shared_ptr<const EnvironmentMap> environment_map; // or a picture, of a sky too
        std::shared_ptr<const SkyLight> sky;                   // what a camera sees of it
        std::vector<Bsdf> bsdfs;
        std::vector<std::shared_ptr<const PreparedMesh>> meshes; // kept alive
        GeometryReport geometry;
        NumericsReport numerics;
        // How to shade an instance: one entry an object, in their order.
        struct Look {
            std::uint32_t first_bsdf = 0;       // with a material for each of the mesh's: the first of them
            const Mesh* materials_of = nullptr; // the mesh whose triangles choose their bsdf; or none
            const Mesh* normals_of = nullptr;   // the mesh whose normals are interpolated; or none: flat

            std::uint32_t bsdf_of(std::uint32_t primitive) const
            {
                const bool by_triangle = materials_of != nullptr && !materials_of->triangle_materials.empty();
                return first_bsdf + (by_triangle ? materials_of->triangle_materials[primitive] : 0u);
            }
        };
        std::vector<Look> looks;
        Media media_at_camera;    // that its eye is inside of
        SurfaceTextures textures; // by the numbers of bsdfs
    };
    explicit Scene(Parts parts) : parts_(std::move(parts)) {}

    const Camera& camera() const { return parts_.camera; }
    const InstanceTree& tree() const { return parts_.tree; }
    std::span<const PreparedLight> lights() const { return parts_.lights.listed; }
    std::span<const Sun> suns() const { return parts_.lights.suns; }
    std::span<const Emitter> emitters() const { return parts_.lights.emitters; }
    static constexpr std::uint32_t kNoEmitter = 0xffffffff;
    std::uint32_t emitter_at(const SceneHit& hit) const
    {
        const auto found = parts_.lights.emitter_of.find(std::uint64_t{hit.instance} << 32 | hit.primitive);
        return found == parts_.lights.emitter_of.end() ? kNoEmitter : found->second;
    }
    const LightTree& light_tree() const { return parts_.lights.tree; }
    // Of a number that the tree picked: a light without extent, or nullptr for an emitter.
    const PreparedLight* picked_light(std::uint32_t number) const
    {
        return number < parts_.lights.emitters.size()
                   ? nullptr
                   : &parts_.lights.picked[number - parts_.lights.emitters.size()];
    }
    const Media& media_at_camera() const { return parts_.media_at_camera; }
    Rgb environment() const { return parts_.environment; }
    const EnvironmentMap* environment_map() const
    {
        return parts_.environment_map.get();
    }                                                        // instead; or nullptr
    const SkyLight* sky() const { return parts_.sky.get(); } // of an atmosphere; or nullptr
    // The sky's own sun is the first of suns(), unless it has set or is a point.
    bool sun_is_of_sky(std::size_t number) const { return number == 0 && parts_.lights.first_sun_is_of_sky; }
    const GeometryReport& geometry() const { return parts_.geometry; }
    const NumericsReport& numerics() const { return parts_.numerics; }

    // As of tree(), but that rays go on through holes which textures make. Scenes without such pay nothing.
    std::uint64_t closest_hits(std::span<const Ray> rays, std::span<SceneHit> hits, RayKind kind) const
    {
        const std::uint64_t hit = parts_.tree.closest_hits(rays, hits, kind);
        return parts_.textures.has_holes() ? past_holes(rays, hits, kind, hit) : hit;
    }
    std::uint64_t any_hits(std::span<const Ray> rays) const
    {
        const std::uint64_t hit = parts_.tree.any_hits(rays);
        return parts_.textures.has_holes() ? behind_holes(rays, hit) : hit;
    }

    // `toward_viewer` points away from the surface, any length but zero. `room`: for the material where a picture
    // gives it; without room the pictures' means are taken. `width`: of what the ray stands for, where it arrives,
    // in metres; 0 where that is not known.
    Surface
    surface_at(const SceneHit& hit, Vec3d toward_viewer, BsdfRoom* room = nullptr, double width = 0) const;

    // Whose boundary that is, if it is of glass.
    BodyId body_at(const SceneHit& hit) const { return {hit.instance, material_at(hit)}; }

private:
    std::uint32_t material_at(const SceneHit& hit) const;
    bool is_hole(const SceneHit& hit) const;
    std::uint64_t
    past_holes(std::span<const Ray> rays, std::span<SceneHit> hits, RayKind kind, std::uint64_t hit) const;
    std::uint64_t behind_holes(std::span<const Ray> rays, std::uint64_t hit) const;
    // The material at that point, made in `room`; turns `shading` where a map says so.
    const Bsdf* dress(const SceneHit& hit,
                      const TexturedMaterial& textured,
                      Vec3d toward_viewer,
                      BsdfRoom& room,
                      double width,
                      Vec3d& shading) const;
    Vec3d shading_normal(const SceneHit& hit, const Mesh& mesh) const;

    Parts parts_;
};

// meshes[i] is the prepared form of description.meshes[i], images[i] the decoded one of description.images[i]; `plan` is make_plan's for this very scene, so that
// nothing is checked again. What an earlier scene left in `caches`, if there are such, is not made again. Builds the trees of the parts that objects name: nullptr only if
// `stop` was requested meanwhile.
std::shared_ptr<const Scene> prepare(const AssumedScene& scene,
                                     const Plan& plan,
                                     std::span<const std::shared_ptr<const PreparedMesh>> meshes,
                                     const RenderSettings& settings,
                                     ThreadPool& pool,
                                     const std::stop_token& stop = {},
                                     std::span<const SharedImage> images = {},
                                     SceneCaches* caches = nullptr);

} // namespace renderer
