#include "renderer/plan/choices.h"

#include "renderer/description/textured_values.h"
#include "renderer/plan/light_shapes.h"
#include "renderer/plan/material_choices.h"
#include "renderer/plan/mesh_use.h"

#include <cstdio>
#include <set>
#include <string>
#include <utility>
#include <variant>

namespace renderer {

namespace {

// What stands in a scene, counted.
struct Census {
    std::size_t objects = 0; // in all
    std::size_t mesh_objects = 0, rectangles = 0, disks = 0, boxes = 0, spheres = 0;
    std::size_t smooth = 0, flat_with_normals = 0, textured_meshes = 0;
    std::size_t textured = 0, normal_mapped = 0, cut_out = 0; // objects
    MaterialCensus materials;
    std::set<std::uint32_t> shown_meshes; // with materials of their own
    std::size_t shining = 0, emissive = 0, transparent = 0, metal = 0, rough = 0; // materials of shown_meshes
    std::size_t idle_normals = 0, idle_uvs = 0, idle_materials = 0; // meshes that have them, and nothing asks
    std::size_t point = 0, spot = 0, directional = 0, sun = 0, area = 0;
    bool sky = false, sky_picture = false, sky_air = false;
};

template <typename T, typename Variant>
std::size_t is_a(const Variant& value)
{
    return std::holds_alternative<T>(value) ? 1u : 0u;
}

void count_object(Census& c,
                  const ObjectDescription& object,
                  const SceneDescription& scene,
                  std::span<const MeshFacts> meshes)
{
    const MeshFacts* facts = nullptr;
    if (const auto* const mesh = std::get_if<MeshShape>(&object.shape)) {
        ++c.mesh_objects;
        facts = &meshes[mesh->mesh];
        if (facts->has_normals) ++(object.shading == Shading::flat ? c.flat_with_normals : c.smooth);
    }
    c.rectangles += is_a<RectangleShape>(object.shape);
    c.disks += is_a<DiskShape>(object.shape);
    c.boxes += is_a<BoxShape>(object.shape);
    c.spheres += is_a<SphereShape>(object.shape);
    if (object.material) {
        const Material& material = scene.materials[*object.material].material;
        if (is_textured(material)) ++c.textured;
        if (normal_map_of(material) != nullptr) ++c.normal_mapped;
        return count_material(c.materials, material);
    }
    if (facts == nullptr || !facts->has_materials) {
        ++c.materials.default_diffuse;
        return;
    }
    if (facts->images > 0 && facts->has_uvs)
        ++c.textured;
    else if (facts->has_textures)
        ++c.textured_meshes;
    if (facts->normal_mapped > 0) ++c.normal_mapped;
    if (facts->cutouts > 0) ++c.cut_out;
    if (c.shown_meshes.insert(std::get<MeshShape>(object.shape).mesh).second) {
        c.shining += facts->shining_materials;
        c.emissive += facts->emissive_materials;
        c.transparent += facts->transparent_materials;
        c.metal += facts->metal_materials;
        c.rough += facts->rough_materials;
    }
    if (facts->glass_materials > facts->rough_glass_materials) ++c.materials.glass;
    if (facts->rough_glass_materials > 0) ++c.materials.rough_glass;
    if (facts->is_all_glass) return;
    ++(facts->physical_materials > 0 ? c.materials.cook_torrance
       : facts->has_specular         ? c.materials.phong_normalized
                                     : c.materials.diffuse);
}

Census census_of(const SceneDescription& scene, std::span<const MeshFacts> meshes)
{
    Census c;
    c.objects = scene.objects.size();
    for (const ObjectDescription& object : scene.objects)
        count_object(c, object, scene, meshes);
    const std::vector<MeshUse> uses = uses_of(scene, meshes);
    for (std::size_t i = 0; i < uses.size(); ++i) {
        c.idle_normals += meshes[i].has_normals && !uses[i].normals;
        c.idle_uvs += meshes[i].has_uvs && !uses[i].uvs;
        c.idle_materials += meshes[i].has_materials && !uses[i].materials;
    }
    for (const Light& light : scene.lights) {
        c.point += is_a<PointLight>(light);
        c.spot += is_a<SpotLight>(light);
        c.directional += is_a<DirectionalLight>(light);
        c.sun += is_a<SunLight>(light);
        c.area += shape_of(light) ? 1u : 0u;
    }
    c.sky_picture = scene.environment && std::holds_alternative<ImageEnvironment>(*scene.environment);
    c.sky_air = scene.environment && std::holds_alternative<AtmosphereDescription>(*scene.environment);
    c.sky = scene.environment && std::holds_alternative<ColorEnvironment>(*scene.environment);
    return c;
}

std::string of(std::size_t count, const char* what)
{
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

class Explainer {
public:
    Explainer(const Census& census,
              const SceneDescription& scene,
              const RenderSettings& settings,
              const Budget& budget,
              const JoinedObjects& joined,
              TransportChoice transport)
        : c_(census), scene_(scene), settings_(settings), budget_(budget), joined_(joined),
          transport_(std::move(transport))
    {
    }

    ModelReport run(const std::vector<ModelChoice>& assumed)
    {
        out_.used = assumed;
        camera();
        out_.used.insert(out_.used.end(), transport_.used.begin(), transport_.used.end());
        out_.skipped.insert(out_.skipped.end(), transport_.skipped.begin(), transport_.skipped.end());
        geometry();
        trees();
        if (is_lit(transport_.integrator)) {
            shading();
            lights();
        }
        layers();
        return std::move(out_);
    }

private:
    void use(std::string name, std::string why) { out_.used.push_back({std::move(name), std::move(why)}); }
    void skip(std::string name, std::string why)
    {
        out_.skipped.push_back({std::move(name), std::move(why)});
    }
    void skip_if(std::size_t count, const char* name, const std::string& why)
    {
        if (count != 0) skip(name, why);
    }
    void use_if(std::size_t count, const char* name, const std::string& why)
    {
        if (count != 0) use(name, why);
    }

    void layers()
    {
        if (const std::string names = names_of(settings_.image.layers); !names.empty())
            use("layers", names + ": `image.layers` asks for them; of what camera rays hit first anyway");
    }

    void camera()
    {
        switch (scene_.camera->projection) {
        case Projection::perspective:
            if (scene_.camera->lens_radius_m > 0)
                use("thin_lens", "rays start all over the lens and meet in the plane of focus");
            else
                use("pinhole_camera", "one ray a sample, jittered in the pixel: a box filter of one pixel");
            break;
        case Projection::orthographic:
            use("orthographic_camera", "rays are parallel");
            break;
        case Projection::panorama:
            use("panorama_camera", "every direction around one point");
            break;
        case Projection::meter:
            use("meter", "light is measured at one point: numbers, no picture");
            break;
        }
    }

    void geometry()
    {
        use_if(c_.mesh_objects + c_.boxes,
               "watertight_triangles",
               of(c_.mesh_objects + c_.boxes, "object") +
                   " made of triangles: no ray slips through a shared edge");
        use_if(c_.rectangles + c_.disks,
               "flat_shapes",
               of(c_.rectangles + c_.disks, "rectangle or disk object"));
        use_if(c_.spheres, "exact_spheres", of(c_.spheres, "sphere") + ", intersected as spheres");
        idle_attributes();
    }

    void idle_attributes()
    {
        std::string idle;
        const auto add = [&](std::size_t meshes, const char* what) {
            if (meshes == 0) return;
            idle += (idle.empty() ? "" : ", ") + std::string(what) + " of " +
                    (meshes == 1 ? "1 mesh" : std::to_string(meshes) + " meshes");
        };
        add(c_.idle_normals, "normals");
        add(c_.idle_uvs, "texture coordinates");
        add(c_.idle_materials, "materials");
        if (!idle.empty()) skip("mesh_attributes", "nothing asks for them: " + idle);
    }

    void trees()
    {
        const AccelerationSettings& asked = settings_.acceleration;
        if (asked.levels != BvhLevels::two)
            skip("two_level_bvh", "`acceleration` asks for no tree over the objects");
        else if (joined_.count != 0 && joined_.count == c_.objects + c_.area)
            skip("two_level_bvh", "all objects are joined in one mesh, which is asked directly");
        else if (c_.objects > 1)
            use("two_level_bvh", "objects are placed over their meshes' own trees, so instances share one");
        else
            skip("two_level_bvh",
                 c_.objects == 1 ? "a single object is asked directly" : "there is no object to be found");
        if (joined_.count != 0)
            use("joined_objects",
                of(joined_.count, "small object") + " with " + std::to_string(joined_.triangles) +
                    " triangles in all are traced as one mesh in the scene's frame");
        if (asked.levels != BvhLevels::two)
            use("object_list",
                std::string("`acceleration` asks for it: a ray asks every object") +
                    (asked.bounds ? " whose box it meets" : ""));
        if (asked.levels == BvhLevels::none)
            use("triangle_list", "`acceleration` asks for it: " + tests_predicted());
        else if (asked.width == BvhWidth::binary)
            use("binary_bvh", "`acceleration` asks for it: two children a node, one ray at a time");
        if (asked.levels != BvhLevels::none && asked.split == BvhSplit::midpoint)
            use("midpoint_split", "`acceleration` asks for it: nodes are cut in the middle");
    }

    // Shadow rays come on top: how many is not known before.
    std::string tests_predicted() const
    {
        std::string text =
            std::string(settings_.acceleration.bounds ? "a ray in an object's box" : "every ray") +
            " is tested against each of its triangles, " + std::to_string(budget_.listed_triangles) +
            " in all";
        const QualitySettings& quality = settings_.quality;
        if (settings_.acceleration.bounds || (quality.time_s && !quality.samples)) return text;
        char tests[32];
        std::snprintf(tests,
                      sizeof tests,
                      "%.2g",
                      static_cast<double>(budget_.pixels) * quality.samples.value_or(kDefaultSamples) *
                          static_cast<double>(budget_.listed_triangles));
        return text + ": " + tests + " tests for camera rays alone";
    }

    void shading()
    {
        if (c_.smooth != 0)
            use("smooth_normals", of(c_.smooth, "object") + " with vertex normals");
        else
            skip("smooth_normals",
                 c_.flat_with_normals != 0 ? "every object with vertex normals is asked to be flat"
                                           : "no mesh has vertex normals");
        explain_materials(c_.materials, out_);
        textures();
        use_if(c_.shining,
               "mesh_emission",
               of(c_.shining, "material") + " of meshes that shine: their triangles are lights");
        left_out_of_meshes();
    }

    void textures()
    {
        use_if(c_.textured,
               "textures",
               of(c_.textured, "object") +
                   " whose materials are looked up in pictures, filtered to what a pixel sees of them");
        use_if(c_.normal_mapped, "normal_maps", of(c_.normal_mapped, "object") + " with tilted normals");
        use_if(c_.cut_out,
               "alpha_cut_outs",
               of(c_.cut_out, "object") + " with holes where its pictures' alpha says so");
    }

    void left_out_of_meshes()
    {
        skip_if(
            c_.textured_meshes,
            "textures",
            of(c_.textured_meshes, "object") +
                " with textures of the mesh's own that did not come, cannot be read, or have no coordinates: "
                "their plain colours are used");
        skip_if(c_.emissive,
                "emission",
                of(c_.emissive, "material") +
                    " of meshes would shine as a picture says: only whole surfaces of one colour do");
        skip_if(c_.transparent,
                "transparency",
                of(c_.transparent, "material") +
                    " of meshes would let light through: only closed bodies of glass do");
        skip_if(c_.metal,
                "metal",
                of(c_.metal, "material") + " of meshes would reflect as metal: their colours are diffuse");
        skip_if(c_.rough,
                "roughness",
                of(c_.rough, "material") +
                    " of meshes with a roughness below 1: they are shaded without its highlight");
    }

    void lights()
    {
        const std::size_t without_extent = c_.point + c_.spot + c_.directional,
                          all = without_extent + c_.sun + c_.area;
        use_if(c_.point, "point_lights", of(c_.point, "point light"));
        use_if(c_.spot, "spot_lights", of(c_.spot, "spot light"));
        use_if(c_.directional, "directional_lights", of(c_.directional, "directional light"));
        use_if(without_extent, "hard_shadows", "one shadow ray a light and sample, which ends at the light");
        use_if(c_.sun, "sun_disk", of(c_.sun, "sun") + " of its angular size: shadows have penumbras");
        use_if(
            c_.area, "area_lights", of(c_.area, "light") + " with a surface, sampled by what of it is seen");
        if (transport_.picks_lights)
            use("light_tree",
                "lights are many: one is picked for each point, likelier the more it may send there");
        if (c_.sky_picture)
            use("environment_image",
                "a picture all around is background and light: one shadow ray a point, drawn by what it "
                "gives");
        else if (c_.sky)
            use("environment_light",
                "the environment's colour is background and light: one ray a sample, drawn by the material");
        else if (!c_.sky_air)
            skip("environment_light", "the environment is none");
        if (all == 0 && !c_.sky && !c_.sky_picture && !c_.sky_air)
            skip("lights",
                 "the scene has no light and says that its environment is none: nothing but what surfaces "
                 "give "
                 "themselves shines");
    }

    const Census& c_;
    const SceneDescription& scene_;
    const RenderSettings& settings_;
    const Budget& budget_;
    const JoinedObjects& joined_;
    TransportChoice transport_;
    ModelReport out_;
};

} // namespace

ModelReport explain(const AssumedScene& scene,
                    std::span<const MeshFacts> meshes,
                    const RenderSettings& settings,
                    const Budget& budget,
                    const JoinedObjects& joined,
                    TransportChoice transport)
{
    const Census census = census_of(scene.description, meshes);
    return Explainer(census, scene.description, settings, budget, joined, std::move(transport))
        .run(scene.assumed);
}

} // namespace renderer
