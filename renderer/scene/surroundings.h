// What is around a scene, and around the eye in it: the environment's picture, and the bodies of glass.
#pragma once

#include "renderer/accel/instance_tree.h"
#include "renderer/lights/environment_map.h"
#include "renderer/scene/scene.h"

#include <memory>
#include <span>

namespace renderer {

// A picture of all around, texel by texel; nullptr where the environment is none. Numbers below 0 count as 0.
std::shared_ptr<const EnvironmentMap> environment_map(const SceneDescription& scene,
                                                      std::span<const SharedImage> images);

// The bodies of glass around a point: those that a ray from there leaves without having entered them. The one that it
// leaves last was entered first.
Media media_around(Vec3d point,
                   const InstanceTree& tree,
                   std::span<const Bsdf> bsdfs,
                   std::span<const Scene::Parts::Look> looks);

} // namespace renderer
