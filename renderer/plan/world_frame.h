// world_frame: the frame that a scene is prepared and traced in: the world's, its origin moved near the camera where
// the camera stands far from the world's own.
//
// Why     at 1e9 m a double is 1.2e-7 m wide, and everything that is computed there rounds to that; near its own
//         origin a scene keeps its digits, and the same scene elsewhere has the same picture to the bit.
// Rule    what is nearest to the camera has a scale: its distance, or its size where the camera is within its box.
//         The origin is a multiple of 1024 scales or more, a power of two: zero for every scene at home, and exact to
//         subtract from places that are as exact as the camera's.
#pragma once

#include "renderer/description/scene_description.h"
#include "renderer/plan/plan.h"

#include <span>

namespace renderer {

// In the world; zero: the world's frame is kept. The scene has a camera and has passed check_description.
Vec3d choose_world_origin(const SceneDescription& scene, std::span<const MeshFacts> meshes);

// From the camera to the nearest of the object's box; zero within it.
double camera_distance(const CameraDescription& camera,
                       const ObjectDescription& object,
                       std::span<const MeshFacts> meshes);

} // namespace renderer
