// world_bounds: the box around everything that a scene's objects can fill, from the meshes' facts alone.
//
// Frame   world, in double. Empty if there is no object. Conservative: boxes of boxes.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/math/bounds.h"
#include "renderer/plan/plan.h"

#include <array>
#include <span>

namespace renderer {

// The object's own box, before its transform. A mesh index without facts gives an empty box.
Bounds3d object_bounds(const Shape& shape, std::span<const MeshFacts> meshes);

// The eight corners of the object's own box, placed in the world.
std::array<Vec3d, 8> world_corners(const ObjectDescription& object, std::span<const MeshFacts> meshes);

Bounds3d world_bounds(const SceneDescription& scene, std::span<const MeshFacts> meshes);

} // namespace renderer
