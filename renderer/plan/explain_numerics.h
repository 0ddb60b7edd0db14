// explain_numerics: the plan's choices of frames and precision, in words for the user.
#pragma once

#include "renderer/description/report.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/plan.h"

#include <span>
#include <string>

namespace renderer {

// Adds the models used and left out: where meshes and scene are kept, and which corners are more than floats.
void explain_numerics(const SceneDescription& scene,
                      std::span<const MeshFacts> meshes,
                      const ImageSettings& image,
                      Vec3d world_origin,
                      ModelReport& models);

// "float", "double" or "mixed": of the corners of the meshes that objects name; "double" where there is none.
std::string corner_precision(const SceneDescription& scene, std::span<const MeshFacts> meshes);

} // namespace renderer
