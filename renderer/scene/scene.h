// Scene: everything rays need, immutable and shared: instances over prepared meshes, materials, lights, camera.
//
// prepare() is the only way to get one; the description has been through assume_defaults and make_plan.
#pragma once

#include "renderer/accel/prepared_mesh.h"
#include "renderer/description/scene_description.h"
#include "renderer/plan/plan.h"

#include <memory>
#include <span>

namespace renderer {

class Scene;

// meshes[i] is the prepared form of description.meshes[i].
std::shared_ptr<const Scene> prepare(const AssumedScene& scene, const Plan& plan,
                                     std::span<const std::shared_ptr<const PreparedMesh>> meshes,
                                     const RenderSettings& settings, ThreadPool& pool);

} // namespace renderer
