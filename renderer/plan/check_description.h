// check_description: every fault that can be told from a description, its meshes' facts and the settings, all
// at once.
//
// What passes can be prepared and rendered: every index in range, every place finite, every transform
// invertible, camera and lights with a direction, lights of finite brightness. Materials and the environment
// are taken as they are: whatever they say can be rendered, and samples that are not finite are counted.
#pragma once

#include "renderer/description/fault_list.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/plan.h"

#include <span>

namespace renderer {

void check_description(const SceneDescription& scene, std::span<const MeshFacts> meshes, FaultList& faults);
void check_settings(const RenderSettings& settings, FaultList& faults);

} // namespace renderer
