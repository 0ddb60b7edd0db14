#include "renderer/plan/check_description.h"

#include "renderer/description/check_atmosphere.h"
#include "renderer/description/textured_values.h"
#include "renderer/plan/light_shapes.h"
#include "renderer/plan/placement.h"
#include "renderer/plan/world_bounds.h"

#include <cmath>
#include <map>
#include <string>
#include <variant>

namespace renderer {

namespace {

// Beyond this a float ray kernel cannot square a coordinate.
constexpr double kLargestCoordinate = 1e18;

bool is_direction(Vec3d v)
{
    return is_finite(v) && max_component(abs(v)) > 0;
}

bool is_finite(Rgb c)
{
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

std::string name_list(const std::map<std::string, PartFacts>& parts)
{
    constexpr std::size_t kMost = 20;
    std::string list;
    std::size_t told = 0;
    for (const auto& [name, facts] : parts) {
        if (told++ == kMost) break;
        list += (list.empty() ? "\"" : ", \"") + name + "\"";
    }
    if (parts.size() > kMost) list += ", and " + std::to_string(parts.size() - kMost) + " more";
    return list;
}

bool is_size(double x)
{
    return std::isfinite(x) && x > 0;
}

bool has_size(const Shape& shape)
{
    if (const auto* const r = std::get_if<RectangleShape>(&shape))
        return is_size(r->width_m) && is_size(r->height_m);
    if (const auto* const d = std::get_if<DiskShape>(&shape)) return is_size(d->radius_m);
    if (const auto* const s = std::get_if<SphereShape>(&shape)) return is_size(s->radius_m);
    if (const auto* const b = std::get_if<BoxShape>(&shape))
        return is_size(b->size_m.x) && is_size(b->size_m.y) && is_size(b->size_m.z);
    return true;
}

class Checker {
public:
    Checker(const SceneDescription& scene, std::span<const MeshFacts> meshes, FaultList& faults)
        : scene_(scene), meshes_(meshes), faults_(faults)
    {
    }

    void run()
    {
        if (scene_.camera) check(*scene_.camera);
        if (const auto* const atmosphere =
                scene_.environment ? std::get_if<AtmosphereDescription>(&*scene_.environment) : nullptr)
            for (Fault& found : check_atmosphere(*atmosphere, "/scene/environment"))
                faults_.add(std::move(found));
        for (std::size_t i = 0; i < scene_.objects.size(); ++i)
            check(scene_.objects[i], "/scene/objects/" + std::to_string(i));
        for (std::size_t i = 0; i < scene_.lights.size(); ++i)
            check(scene_.lights[i], "/scene/lights/" + std::to_string(i));
    }

private:
    void fault(std::string pointer, std::string code, std::string detail)
    {
        faults_.add({std::move(pointer), std::move(code), std::move(detail)});
    }

    void check(const CameraDescription& camera)
    {
        if (!(camera.lens_radius_m >= 0) || !std::isfinite(camera.lens_radius_m))
            fault("/scene/camera/lens_radius", "out_of_range", "a radius is finite and not below 0");
        if (camera.focus_distance_m && !is_size(*camera.focus_distance_m))
            fault("/scene/camera/focus_distance", "out_of_range", "a distance is finite and above 0");
        if (!is_size(camera.height_m))
            fault("/scene/camera/height", "out_of_range", "a height is finite and above 0");
        const std::string aim = camera.aim_is_direction ? "/scene/camera/direction" : "/scene/camera/look_at";
        if (!(camera.fov_deg > 0 && camera.fov_deg < 180))
            fault("/scene/camera/fov_deg",
                  "out_of_range",
                  std::to_string(camera.fov_deg) + " is not between 0 and 180 degrees, both excluded");
        if (!is_finite(camera.position))
            fault("/scene/camera/position", "not_finite", "every number must be finite");
        const Vec3d forward = camera.aim_is_direction ? camera.aim : camera.aim - camera.position;
        if (!is_direction(forward))
            fault(aim,
                  "out_of_range",
                  camera.aim_is_direction
                      ? "a direction must not be (0, 0, 0)"
                      : "the camera stands at the very point it looks at: move one of the two");
        if (!is_direction(camera.up)) fault("/scene/camera/up", "out_of_range", "up must not be (0, 0, 0)");
    }

    void check_mesh(const MeshShape& shape, const std::string& at)
    {
        if (shape.mesh >= meshes_.size()) return fault(at + "/mesh", "missing_asset", "no such mesh");
        if (shape.part.empty()) return;
        const MeshFacts& facts = meshes_[shape.mesh];
        if (const auto part = facts.parts.find(shape.part); part != facts.parts.end()) {
            if (part->second.triangle_count == 0)
                fault(at + "/part", "no_triangles", "the part \"" + shape.part + "\" has no triangles");
            return;
        }
        fault(at + "/part",
              "unknown_part",
              facts.parts.empty() ? "the mesh has no named parts: leave `part` out"
                                  : "no part \"" + shape.part + "\"; there are " + name_list(facts.parts));
    }

    void check_coordinates(const Shape& shape, const std::string& at)
    {
        const auto* const mesh = std::get_if<MeshShape>(&shape);
        if (mesh != nullptr && mesh->mesh < meshes_.size() && !meshes_[mesh->mesh].has_uvs)
            fault(
                at + "/material",
                "no_texture_coordinates",
                "its material has a texture, and the mesh has no texture coordinates to place it by: export "
                "the mesh with them, or choose a material without textures");
    }

    void check(const ObjectDescription& object, const std::string& at)
    {
        const std::size_t before = faults_.count();
        if (const auto* const mesh = std::get_if<MeshShape>(&object.shape)) check_mesh(*mesh, at);
        if (object.material && *object.material >= scene_.materials.size())
            fault(at + "/material", "unknown_material", "no such material");
        else if (object.material && is_textured(scene_.materials[*object.material].material))
            check_coordinates(object.shape, at);
        if (!has_size(object.shape))
            return fault(at, "out_of_range", "every size of a shape must be finite and above 0");
        if (!placement(object).inverse())
            return fault(
                at + "/transform",
                "singular_transform",
                "the transform flattens the object (its determinant is 0): scale by something other than 0");
        if (faults_.count() != before) return;
        for (const Vec3d& corner : world_corners(object, meshes_))
            if (!is_finite(corner) || max_component(abs(corner)) > kLargestCoordinate)
                return fault(at + "/transform",
                             "out_of_range",
                             "places the object beyond 1e18 m from the origin: scale or move the scene");
    }

    void check(const Light& light, const std::string& at)
    {
        if (const auto* const point = std::get_if<PointLight>(&light)) {
            if (!is_finite(point->position) || !is_finite(point->intensity))
                fault(at, "not_finite", "every number of a light must be finite");
        } else if (const auto* const spot = std::get_if<SpotLight>(&light)) {
            if (!is_finite(spot->position) || !is_finite(spot->intensity))
                fault(at, "not_finite", "every number of a light must be finite");
            check_direction(spot->direction, at);
            if (!(spot->inner_deg >= 0 && spot->inner_deg <= spot->outer_deg && spot->outer_deg <= 180))
                fault(at + "/inner_deg", "out_of_range", "0 <= inner_deg <= outer_deg <= 180 must hold");
        } else if (const auto* const directional = std::get_if<DirectionalLight>(&light)) {
            if (!is_finite(directional->irradiance))
                fault(at, "not_finite", "every number of a light must be finite");
            check_direction(directional->direction, at);
        } else if (const auto* const sun = std::get_if<SunLight>(&light)) {
            if (!is_finite(sun->irradiance))
                fault(at, "not_finite", "every number of a light must be finite");
            check_direction(sun->direction, at);
            if (!(sun->angular_radius_deg > 0 && sun->angular_radius_deg <= 180))
                fault(at + "/angular_radius_deg", "out_of_range", "above 0 and at most 180 degrees");
        } else if (const auto shaped = shape_of(light)) {
            if (!is_finite(shaped->light->radiance) ||
                (shaped->light->power && !is_finite(*shaped->light->power)))
                fault(at, "not_finite", "every number of a light must be finite");
            check(shaped->object, at);
        }
    }

    void check_direction(Vec3d direction, const std::string& at)
    {
        if (!is_direction(direction))
            fault(at + "/direction", "out_of_range", "a direction must not be (0, 0, 0)");
    }

    const SceneDescription& scene_;
    std::span<const MeshFacts> meshes_;
    FaultList& faults_;
};

} // namespace

void check_description(const SceneDescription& scene, std::span<const MeshFacts> meshes, FaultList& faults)
{
    Checker(scene, meshes, faults).run();
}

void check_settings(const RenderSettings& settings, FaultList& faults)
{
    const ImageSettings& image = settings.image;
    if (image.width_px == 0) faults.add({"/image/width", "out_of_range", "0 is not a width: at least 1"});
    if (image.height_px == 0) faults.add({"/image/height", "out_of_range", "0 is not a height: at least 1"});
    if (image.region) {
        const PixelRect& r = *image.region;
        const bool inside = r.width > 0 && r.height > 0 && std::uint64_t{r.x} + r.width <= image.width_px &&
                            std::uint64_t{r.y} + r.height <= image.height_px;
        if (!inside)
            faults.add({"/image/region",
                        "out_of_range",
                        "the region must have at least one pixel and lie within the picture of " +
                            std::to_string(image.width_px) + " x " + std::to_string(image.height_px)});
    }
    if (settings.quality.samples && *settings.quality.samples == 0)
        faults.add({"/quality/samples", "out_of_range", "0 samples make no picture: at least 1"});
    if (settings.quality.time_s && !(*settings.quality.time_s > 0))
        faults.add({"/quality/time_s", "out_of_range", "a time must be above 0 seconds"});
    if (settings.acceleration.tile_px == 0)
        faults.add({"/acceleration/tile", "out_of_range", "0 is not a tile size: at least 1"});
}

} // namespace renderer
