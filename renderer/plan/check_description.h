// check_description: every fault that can be told from a description, its meshes' facts and the settings, all
// at once.
//
// What passes can be prepared and rendered: every index in range, every number finite, every transform
// invertible, camera and lights with a direction.
#pragma once

#include "renderer/description/fault.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/plan.h"

#include <span>
#include <vector>

namespace renderer {

std::vector<Fault> check_description(const SceneDescription& scene, std::span<const MeshFacts> meshes);
std::vector<Fault> check_settings(const RenderSettings& settings);

} // namespace renderer
