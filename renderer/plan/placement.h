// placement: where an object's geometry stands, its own size included; the one formula for check and
// preparation.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/math/affine.h"

namespace renderer {

// Boxes and rectangles are the unit shape scaled, then placed; the other shapes carry their size themselves.
Affine3 placement(const ObjectDescription& object);

} // namespace renderer
