#include "renderer/scene/scene_lights.h"

#include "renderer/color/strongest.h"

#include <algorithm>
#include <optional>
#include <variant>

namespace renderer {

namespace {

void add(SceneLights& lights,
         const std::optional<Emitter>& emitter,
         std::uint32_t instance,
         std::uint32_t primitive)
{
    if (!emitter) return; // without area: no ray meets it
    lights.emitter_of[std::uint64_t{instance} << 32 | primitive] =
        static_cast<std::uint32_t>(lights.emitters.size());
    lights.emitters.push_back(*emitter);
}

LightBounds bounds_for_tree(const Emitter& e)
{
    const bool has_sides =
        e.shape != EmitterShape::sphere && e.shape != EmitterShape::ellipsoid && !e.two_sided;
    return {bounds_of(e), power_of(e), e.normal, has_sides ? 1.0 : -1.0};
}

LightBounds bounds_for_tree(const PreparedLight& light)
{
    LightBounds b;
    b.box.extend(light.position);
    // Of a point's intensity the power is 4 pi times as much; a spot counts as a point, since it may be aimed anywhere.
    constexpr double kFourPi = 12.566370614359172954;
    b.power = kFourPi * static_cast<double>(strongest(light.strength));
    return b;
}

const Mesh* mesh_in(const InstanceGeometry& geometry)
{
    if (const auto* const mesh = std::get_if<MeshGeometry>(&geometry)) return mesh->mesh;
    if (const auto* const mesh = std::get_if<BaselineGeometry>(&geometry)) return mesh->mesh;
    return nullptr;
}

} // namespace

void SceneLights::pick_by_tree()
{
    const auto has_place = [](const PreparedLight& light) { return light.kind != LightKind::directional; };
    std::copy_if(listed.begin(), listed.end(), std::back_inserter(picked), has_place);
    listed.erase(std::remove_if(listed.begin(), listed.end(), has_place), listed.end());
    std::vector<LightBounds> all;
    all.reserve(emitters.size() + picked.size());
    for (const Emitter& emitter : emitters)
        all.push_back(bounds_for_tree(emitter));
    for (const PreparedLight& light : picked)
        all.push_back(bounds_for_tree(light));
    tree = LightTree(all);
}

void add_emitters(SceneLights& lights,
                  const Instance& instance,
                  std::uint32_t number,
                  std::uint32_t first_triangle,
                  std::uint32_t triangle_count,
                  Rgb radiance,
                  bool two_sided)
{
    const Affine3& placed = instance.world_from_object();
    if (const auto* const sphere = std::get_if<Sphere>(&instance.geometry()))
        return add(lights, sphere_emitter(placed, sphere->radius, radiance, two_sided), number, 0);
    if (const auto* const disk = std::get_if<Disk>(&instance.geometry()))
        return add(lights, disk_emitter(placed, disk->radius, radiance, two_sided), number, 0);
    const Mesh& mesh = *mesh_in(instance.geometry());
    const bool mirrored = placed.determinant() < 0;
    for (std::uint32_t i = first_triangle; i < first_triangle + triangle_count; ++i) {
        const Triangle& t = mesh.triangles[i];
        const Vec3d a = placed.point(mesh.position(t[0])), b = placed.point(mesh.position(t[1])),
                    c = placed.point(mesh.position(t[2]));
        // Mirrored, its outside is on the other side of its winding.
        add(lights, triangle_emitter(a, mirrored ? c : b, mirrored ? b : c, radiance, two_sided), number, i);
    }
}

void add_rectangle(
    SceneLights& lights, const Instance& instance, std::uint32_t number, Rgb radiance, bool two_sided)
{
    const std::optional<Emitter> emitter =
        rectangle_emitter(instance.world_from_object(), radiance, two_sided);
    add(lights, emitter, number, 0);
    if (emitter)
        lights.emitter_of[std::uint64_t{number} << 32 | 1] =
            static_cast<std::uint32_t>(lights.emitters.size() - 1);
}

} // namespace renderer
