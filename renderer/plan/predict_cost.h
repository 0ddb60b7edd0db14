// predict_cost: rays, memory and time of a render, from counts alone.
#pragma once

#include "renderer/description/report.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/choose_transport.h"

namespace renderer {

// A ray with its shading on one thread of a processor of the 2020s; scenes differ by several times either way.
inline constexpr double kSecondsARay = 0.7e-6;
// Scatterings of a path that roulette ends, at albedos about one half.
inline constexpr double kUsualScatterings = 3;

// As many as `quality` allows.
std::uint64_t most_camera_rays(const RenderSettings& settings);
// Of all kinds, in the time that `quality` gives, about; infinite where it gives none.
double most_rays_in_time(const RenderSettings& settings);

Prediction predict_cost(const SceneDescription& scene,
                        const RenderSettings& settings,
                        const Budget& budget,
                        const TransportChoice& transport);

} // namespace renderer
