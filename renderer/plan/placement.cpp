#include "renderer/plan/placement.h"

#include <variant>

namespace renderer {

Affine3 placement(const ObjectDescription& object)
{
    if (const auto* const box = std::get_if<BoxShape>(&object.shape))
        return object.world_from_object * Affine3::scale(box->size_m);
    if (const auto* const rectangle = std::get_if<RectangleShape>(&object.shape))
        return object.world_from_object * Affine3::scale({rectangle->width_m, rectangle->height_m, 1});
    return object.world_from_object;
}

} // namespace renderer
