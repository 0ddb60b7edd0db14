// scene_frame: from the units and axes of a file that says them (FBX) to metres with y up.
#pragma once

#include "renderer/math/affine.h"

struct aiScene;

namespace renderer {

// Identity where the scene says nothing: its reader has seen to that, or there is nothing to say.
Affine3 world_from_file(const aiScene& scene);

} // namespace renderer
