#include "renderer/plan/light_shapes.h"

namespace renderer {

std::optional<LightShape> shape_of(const Light& light)
{
    LightShape out{};
    if (const auto* const rectangle = std::get_if<RectangleLight>(&light)) {
        out.object.shape = RectangleShape{rectangle->width_m, rectangle->height_m};
        out.light = rectangle;
    } else if (const auto* const disk = std::get_if<DiskLight>(&light)) {
        out.object.shape = DiskShape{disk->radius_m};
        out.light = disk;
    } else if (const auto* const sphere = std::get_if<SphereLight>(&light)) {
        out.object.shape = SphereShape{sphere->radius_m};
        out.light = sphere;
    } else {
        return std::nullopt;
    }
    out.object.world_from_object = out.light->world_from_light;
    out.object.visible_to_camera = out.light->visible_to_camera;
    return out;
}

} // namespace renderer
