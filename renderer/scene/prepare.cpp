#include "renderer/description/textured_values.h"
#include "renderer/geometry/shapes.h"
#include "renderer/math/floating_point_mode.h"
#include "renderer/plan/light_shapes.h"
#include "renderer/plan/placement.h"
#include "renderer/scene/mesh_materials.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/surroundings.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

namespace renderer {

namespace {

using SharedMesh = std::shared_ptr<const PreparedMesh>;

// The camera and the lights in the frame that is traced in.
CameraDescription moved(CameraDescription camera, Vec3d world_origin)
{
    if (!camera.aim_is_direction) {
        camera.aim = camera.aim - camera.position;
        if (!camera.focus_distance_m) camera.focus_distance_m = length(camera.aim);
    }
    camera.aim_is_direction = true;
    camera.position = camera.position - world_origin;
    return camera;
}

Light moved(Light light, Vec3d world_origin)
{
    if (auto* const point = std::get_if<PointLight>(&light))
        point->position = point->position - world_origin;
    else if (auto* const spot = std::get_if<SpotLight>(&light))
        spot->position = spot->position - world_origin;
    return light; // those with a shape are placed as objects are
}

class Preparation {
public:
    Preparation(const SceneDescription& scene,
                const Plan& plan,
                std::span<const SharedMesh> meshes,
                std::span<const SharedImage> images,
                MeshTree tree,
                ThreadPool& pool,
                const std::stop_token& stop)
        : scene_(scene), plan_(plan), world_origin_(plan.world_origin), meshes_(meshes), tree_(tree),
          pool_(pool), stop_(stop)
    {
        for (const NamedMaterial& material : scene.materials)
            add_material(of_scene(material.material), images);
        default_bsdf_ = next_bsdf();
        bsdfs.push_back(make_bsdf(DiffuseMaterial{}));
    }

    // Every object of the scene, and every light that has a shape; false if `stop` was requested.
    bool run()
    {
        instances.reserve(scene_.objects.size());
        looks.reserve(scene_.objects.size());
        for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
            const ObjectDescription& object = scene_.objects[i];
            if (object.material && is_nothing(*object.material)) continue;
            if (stop_.stop_requested() || !add(object, is_chosen(plan_.joined.objects, i))) return false;
        }
        for (std::size_t i = 0; i < scene_.lights.size(); ++i)
            if (!add(scene_.lights[i], is_chosen(plan_.joined.lights, i))) return false;
        return join();
    }

    std::vector<Bsdf> bsdfs;
    SurfaceTextures textures;
    std::vector<Instance> instances;
    std::optional<JoinedMesh> joined; // of them, the small ones
    std::vector<Scene::Parts::Look> looks;
    SceneLights lights;
    std::vector<SharedMesh> held;
    GeometryReport geometry;
    NumericsReport numerics;

private:
    static bool is_chosen(const std::vector<bool>& joined, std::size_t i)
    {
        return i < joined.size() && joined[i];
    }

    static TexturedMaterial of_scene(const Material& material)
    {
        TexturedMaterial textured{.material = material};
        if (const TextureUse* const map = normal_map_of(material)) textured.normal_map = *map;
        return textured;
    }

    void add_material(const TexturedMaterial& material, std::span<const SharedImage> images)
    {
        bsdfs.push_back(make_bsdf(textures.add(next_bsdf(), material, images)));
        bsdfs.back().emission += material.emission;
    }

    std::uint32_t next_bsdf() const { return static_cast<std::uint32_t>(bsdfs.size()); }

    void hold(const SharedMesh& mesh)
    {
        if (!seen_.insert(mesh.get()).second) return;
        held.push_back(mesh);
        // Parts share the arrays of their whole, which count once.
        if (counted_.insert(&mesh_of(*mesh)).second) geometry.triangles += mesh_of(*mesh).triangles.size();
        geometry.bvh_bytes += bvh_bytes(*mesh);
        numerics.degenerate_triangles += degenerate_triangles(*mesh);
    }

    // Glass that neither bends nor takes light, where no other glass could be displaced by it.
    bool is_nothing(std::uint32_t material) const
    {
        const auto is_clear = [](const NamedMaterial& m) {
            const auto* const glass = std::get_if<GlassMaterial>(&m.material);
            return glass == nullptr || (glass->ior == 1 && is_black(glass->absorption));
        };
        return std::holds_alternative<GlassMaterial>(scene_.materials[material].material) &&
               std::all_of(scene_.materials.begin(), scene_.materials.end(), is_clear);
    }

    bool join()
    {
        if (members_.size() < 2) return true;
        joined = JoinedMesh::join(instances, members_, tree_, pool_, stop_);
        return joined.has_value();
    }

    // `bsdf`: of a light's own shape, instead of a material.
    bool
    add(const ObjectDescription& object, bool is_joined, std::optional<std::uint32_t> bsdf = std::nullopt)
    {
        const auto found = geometry_of(object.shape);
        if (!found) return false;
        const auto& [shape, own, run] = *found;
        const auto instance =
            Instance::place(shape,
                            placement(object, own != nullptr ? own->origin : Vec3d{}, world_origin_),
                            object.visible_to_camera);
        if (!instance)
            throw std::invalid_argument("prepare: an object's transform is singular; make_plan refuses it");
        const auto number = static_cast<std::uint32_t>(instances.size());
        instances.push_back(*instance);
        if (is_joined) members_.push_back({number, {run.first_triangle, run.triangle_count}});
        Scene::Parts::Look look;
        if (object.shading != Shading::flat && own != nullptr && !own->normals.empty()) look.normals_of = own;
        if (bsdf || object.material) {
            look.first_bsdf = bsdf ? *bsdf : *object.material;
        } else if (own != nullptr && !own->materials.empty()) {
            look.first_bsdf = own_materials(*own);
            look.materials_of = own;
        } else {
            look.first_bsdf = default_bsdf_;
        }
        looks.push_back(look);
        ++geometry.instances;
        add_emitters_of(object.shape, *instance, number, look, run);
        return true;
    }

    // What shines of an object's surfaces.
    void add_emitters_of(const Shape& shape,
                         const Instance& instance,
                         std::uint32_t number,
                         const Scene::Parts::Look& look,
                         const MeshPart& run)
    {
        const bool by_triangle =
            look.materials_of != nullptr && !look.materials_of->triangle_materials.empty();
        if (!by_triangle) {
            const Bsdf& bsdf = bsdfs[look.first_bsdf];
            if (is_black(bsdf.emission)) return;
            if (std::holds_alternative<RectangleShape>(shape))
                return add_rectangle(lights, instance, number, bsdf.emission, bsdf.two_sided);
            return add_emitters(lights,
                                instance,
                                number,
                                run.first_triangle,
                                run.triangle_count,
                                bsdf.emission,
                                bsdf.two_sided);
        }
        for (std::uint32_t i = run.first_triangle; i < run.first_triangle + run.triangle_count; ++i) {
            const Bsdf& bsdf = bsdfs[look.bsdf_of(i)];
            if (!is_black(bsdf.emission))
                add_emitters(lights, instance, number, i, 1, bsdf.emission, bsdf.two_sided);
        }
    }

    bool add(const Light& light, bool is_joined)
    {
        if (const auto* const sun = std::get_if<SunLight>(&light)) {
            lights.suns.push_back(prepare_sun(*sun));
            return true;
        }
        const std::optional<LightShape> shaped = shape_of(light);
        if (!shaped) {
            lights.listed.push_back(prepare_light(moved(light, world_origin_)));
            return true;
        }
        const std::size_t first = lights.emitters.size();
        const std::uint32_t bsdf = next_bsdf();
        bsdfs.push_back(make_bsdf(EmitterMaterial{{shaped->light->radiance}, shaped->light->two_sided}));
        if (!add(shaped->object, is_joined, bsdf)) return false;
        if (lights.emitters.size() == first || !shaped->light->power) return true;
        Emitter& emitter = lights.emitters[first];
        emitter.radiance = radiance_of_power(*shaped->light->power, emitter);
        bsdfs[bsdf].emission = emitter.radiance;
        return true;
    }

    // The shape for rays, the user's mesh behind it (not our own box or rectangle, which are flat), and its triangles.
    struct Found {
        InstanceGeometry geometry;
        const Mesh* own = nullptr;
        MeshPart run{};
    };

    // Nothing if `stop` was requested.
    std::optional<Found> geometry_of(const Shape& shape)
    {
        if (const auto* const sphere = std::get_if<SphereShape>(&shape))
            return Found{Sphere{sphere->radius_m}};
        if (const auto* const disk = std::get_if<DiskShape>(&shape)) return Found{Disk{disk->radius_m}};
        if (std::holds_alternative<BoxShape>(shape)) return unit_shape(box_, unit_box);
        if (std::holds_alternative<RectangleShape>(shape)) return unit_shape(rectangle_, unit_rectangle);
        const auto& mesh = std::get<MeshShape>(shape);
        MeshPart run = mesh.part.empty() ? MeshPart{} : run_of(mesh);
        const SharedMesh prepared = mesh.part.empty() ? meshes_[mesh.mesh] : part(mesh, run);
        if (!prepared) return std::nullopt;
        hold(prepared);
        const Mesh& own = mesh_of(*prepared);
        if (mesh.part.empty()) run.triangle_count = static_cast<std::uint32_t>(own.triangles.size());
        return Found{rays_of(*prepared), &own, run};
    }

    static InstanceGeometry rays_of(const PreparedMesh& mesh)
    {
        if (const MeshBvh* const bvh = bvh_of(mesh)) return MeshGeometry{&mesh_of(mesh), bvh};
        return BaselineGeometry{&mesh_of(mesh), baseline_of(mesh)};
    }

    Found unit_shape(SharedMesh& shared, Mesh (*make)())
    {
        if (!shared) shared = prepare_mesh(make(), tree_, pool_);
        hold(shared);
        MeshPart run;
        run.triangle_count = static_cast<std::uint32_t>(mesh_of(*shared).triangles.size());
        return {rays_of(*shared), nullptr, run};
    }

    const MeshPart& run_of(const MeshShape& shape)
    {
        const Mesh& whole = mesh_of(*meshes_[shape.mesh]);
        auto [named, is_new] = named_parts_.try_emplace(shape.mesh);
        if (is_new) named->second = whole.parts_by_name();
        const auto found = named->second.find(shape.part);
        if (found == named->second.end())
            throw std::invalid_argument("prepare: a mesh has no such part; make_plan refuses it");
        return *found->second;
    }

    // Parts that name the same triangles share a tree; one that names all has the mesh's own.
    SharedMesh part(const MeshShape& shape, const MeshPart& run)
    {
        const Mesh& whole = mesh_of(*meshes_[shape.mesh]);
        if (run.triangle_count == whole.triangles.size()) return meshes_[shape.mesh];
        SharedMesh& shared = parts_[{shape.mesh, run.first_triangle, run.triangle_count}];
        if (!shared) shared = prepare_part(meshes_[shape.mesh], run, tree_, pool_, stop_);
        return shared;
    }

    std::uint32_t own_materials(const Mesh& mesh)
    {
        const auto [entry, is_new] = first_own_.try_emplace(&mesh, next_bsdf());
        if (!is_new) return entry->second;
        // They live as long as the mesh, which is held.
        std::vector<SharedImage> images;
        for (const MeshImage& named : mesh.images)
            images.emplace_back(SharedImage(), &named.image);
        for (const MeshMaterial& material : mesh.materials)
            add_material(from_mesh(material), images);
        return entry->second;
    }

    const SceneDescription& scene_;
    const Plan& plan_;
    Vec3d world_origin_;
    std::span<const SharedMesh> meshes_;
    MeshTree tree_; // of parts and shapes
    ThreadPool& pool_;
    const std::stop_token& stop_;
    SharedMesh box_, rectangle_;
    std::vector<JoinedMesh::Member> members_;
    std::set<const PreparedMesh*> seen_;
    std::set<const Mesh*> counted_;
    std::map<std::uint32_t, std::map<std::string_view, const MeshPart*>> named_parts_; // by mesh
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, SharedMesh>
        parts_; // mesh, first, count
    std::map<const Mesh*, std::uint32_t> first_own_;
    std::uint32_t default_bsdf_ = 0;
};

// Largest coordinate over the scene's diagonal: how many digits the place of the scene costs.
double coordinate_ratio(const Bounds3d& bounds, Vec3d world_origin)
{
    if (bounds.empty()) return 0;
    const double diagonal = length(bounds.extent());
    const double largest = std::max(max_component(abs(bounds.lower + world_origin)),
                                    max_component(abs(bounds.upper + world_origin)));
    return diagonal > 0 ? largest / diagonal : 0;
}

Rgb environment_of(const SceneDescription& scene)
{
    const auto* const color =
        scene.environment ? std::get_if<ColorEnvironment>(&*scene.environment) : nullptr;
    return color != nullptr ? color->radiance : Rgb{};
}

} // namespace

std::shared_ptr<const Scene> prepare(const AssumedScene& scene,
                                     const Plan& plan,
                                     std::span<const std::shared_ptr<const PreparedMesh>> meshes,
                                     const RenderSettings& settings,
                                     ThreadPool& pool,
                                     const std::stop_token& stop,
                                     std::span<const SharedImage> images,
                                     SceneCaches* caches)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    const SceneDescription& description = scene.description;
    const AccelerationSettings& acceleration = settings.acceleration;
    Preparation made(description, plan, meshes, images, mesh_tree(acceleration), pool, stop);
    if (!made.run()) return nullptr;
    const auto sky = sky_light(description, plan, pool, stop, caches != nullptr ? &caches->skies : nullptr);
    if (plan.sky && !sky) return nullptr;
    const auto surroundings =
        sky ? light_from(*sky, pool, made.lights) : environment_map(description, images);
    if (plan.picks_lights) made.lights.pick_by_tree();

    InstanceTree tree =
        acceleration.levels == BvhLevels::two
            ? InstanceTree(std::move(made.instances),
                           acceleration.split.value_or(BvhSplit::sah),
                           pool,
                           std::move(made.joined),
                           {caches != nullptr ? &caches->upper_levels : nullptr, plan.prediction.rays},
                           stop)
            : InstanceTree::list(std::move(made.instances), acceleration.bounds, std::move(made.joined));
    if (stop.stop_requested()) return nullptr;
    made.geometry.bvh_bytes += tree.size_bytes();
    made.geometry.upper_level = tree.upper_level();
    made.numerics.coordinate_ratio = coordinate_ratio(tree.bounds(), plan.world_origin);
    made.numerics.precision = plan.precision;
    const Camera camera(moved(description.camera.value(), plan.world_origin),
                        settings.image.width_px,
                        settings.image.height_px);
    const Media media = media_around(camera.position(), tree, made.bsdfs, made.looks);
    return std::make_shared<const Scene>(Scene::Parts{camera,
                                                      std::move(tree),
                                                      std::move(made.lights),
                                                      environment_of(description),
                                                      surroundings,
                                                      sky,
                                                      std::move(made.bsdfs),
                                                      std::move(made.held),
                                                      made.geometry,
                                                      made.numerics,
                                                      std::move(made.looks),
                                                      media,
                                                      std::move(made.textures)});
}

} // namespace renderer
