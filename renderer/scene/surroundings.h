// What is around a scene, and around the eye in it: the environment's picture, and the bodies of glass.
#pragma once

#include "renderer/accel/instance_tree.h"
#include "renderer/lights/environment_map.h"
#include "renderer/scene/scene.h"
#include "renderer/sky/sky_cache.h"
#include "renderer/sky/sky_light.h"

#include <memory>
#include <span>
#include <stop_token>

namespace renderer {

// A picture of all around, texel by texel; nullptr where the environment is none. Numbers below 0 count as 0.
std::shared_ptr<const EnvironmentMap> environment_map(const SceneDescription& scene,
                                                      std::span<const SharedImage> images);

// Sky and sun of an atmosphere as seen from the camera; nullptr where the environment is none, or `stop` was requested.
std::shared_ptr<const SkyLight> sky_light(const SceneDescription& scene,
                                          const Plan& plan,
                                          ThreadPool& pool,
                                          const std::stop_token& stop,
                                          SkyCache* skies);
// The same as a picture all around and a light beside the others.
std::shared_ptr<const EnvironmentMap> light_from(const SkyLight& sky, ThreadPool& pool, SceneLights& lights);

// The bodies of glass around a point: those that a ray from there leaves without having entered them. The one that it
// leaves last was entered first.
Media media_around(Vec3d point,
                   const InstanceTree& tree,
                   std::span<const Bsdf> bsdfs,
                   std::span<const Scene::Parts::Look> looks);

} // namespace renderer
