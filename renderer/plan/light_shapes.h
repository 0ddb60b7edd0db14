// Lights that have a shape: the object that rays meet, for whoever counts, places or traces objects.
#pragma once

#include "renderer/description/scene_description.h"

#include <optional>

namespace renderer {

struct LightShape {
    ObjectDescription object; // without a material
    const AreaLight* light;   // of the light it was made from
};

// Nothing for lights without extent, and for suns, which have no place.
std::optional<LightShape> shape_of(const Light& light);

} // namespace renderer
