#include "renderer/plan/placement.h"

#include <algorithm>
#include <variant>

namespace renderer {

Affine3 placement(const ObjectDescription& object)
{
    if (const auto* const box = std::get_if<BoxShape>(&object.shape))
        return object.world_from_object * Affine3::scale(box->size_m);
    if (const auto* const rectangle = std::get_if<RectangleShape>(&object.shape))
        return object.world_from_object *
               Affine3::scale({rectangle->width_m,
                               rectangle->height_m,
                               std::max(rectangle->width_m, rectangle->height_m)}); // as it has no depth
    return object.world_from_object;
}

Affine3 placement(const ObjectDescription& object, Vec3d own_origin, Vec3d world_origin)
{
    Affine3 placed = placement(object);
    placed.translation = placed.vector(own_origin) + (placed.translation - world_origin);
    return placed;
}

} // namespace renderer
