#include "renderer/plan/light_shapes.h"

#include <utility>
#include <variant>

namespace renderer {

namespace {

LightShape placed(const AreaLight& light, Shape shape)
{
    LightShape out{};
    out.object.shape = std::move(shape);
    out.object.world_from_object = light.world_from_light;
    out.object.visible_to_camera = light.visible_to_camera;
    out.light = &light;
    return out;
}

} // namespace

std::optional<LightShape> shape_of(const Light& light)
{
    if (const auto* const rectangle = std::get_if<RectangleLight>(&light))
        return placed(*rectangle, RectangleShape{rectangle->width_m, rectangle->height_m});
    if (const auto* const disk = std::get_if<DiskLight>(&light))
        return placed(*disk, DiskShape{disk->radius_m});
    if (const auto* const sphere = std::get_if<SphereLight>(&light))
        return placed(*sphere, SphereShape{sphere->radius_m});
    return std::nullopt;
}

} // namespace renderer
