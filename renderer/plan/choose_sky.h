// choose_sky: what an atmosphere needs of its models: how exact its tables, whether the air before things counts, and how
// bright a picture under it is taken.
#pragma once

#include "renderer/description/report.h"
#include "renderer/plan/plan.h"

#include <optional>
#include <span>

namespace renderer {

// Nothing where the environment is no atmosphere, or no light is looked at. Its reasons go to `models`.
std::optional<SkyPlan> choose_sky(const SceneDescription& scene,
                                  std::span<const MeshFacts> meshes,
                                  Integrator integrator,
                                  ModelReport& models);

// What the user says; else 0, or for light under an atmosphere what its sun's elevation and irradiance ask for.
double choose_exposure(const ImageSettings& image,
                       const SceneDescription& scene,
                       Integrator integrator,
                       ModelReport& models);

} // namespace renderer
