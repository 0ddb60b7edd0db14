// placement: where an object's geometry stands, its own size included; the one formula for check and
// preparation.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/math/affine.h"

namespace renderer {

// Boxes and rectangles are the unit shape scaled, then placed; the other shapes carry their size themselves.
Affine3 placement(const ObjectDescription& object);

// The same from and to frames with origins elsewhere: the geometry's (in its file) and the one that is traced in (in
// the world). Where the three places are equally exact nothing rounds.
Affine3 placement(const ObjectDescription& object, Vec3d own_origin, Vec3d world_origin);

} // namespace renderer
