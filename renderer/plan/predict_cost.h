// predict_cost: rays, memory and time of a render, from counts alone.
#pragma once

#include "renderer/description/report.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/choose_transport.h"

namespace renderer {

Prediction predict_cost(const SceneDescription& scene,
                        const RenderSettings& settings,
                        const Budget& budget,
                        const TransportChoice& transport);

} // namespace renderer
