// explain: the plan in words for the user: every model used and every one left out, each with its reason.
#pragma once

#include "renderer/description/report.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/choose_transport.h"
#include "renderer/plan/plan.h"

#include <span>

namespace renderer {

ModelReport explain(const AssumedScene& scene,
                    std::span<const MeshFacts> meshes,
                    const RenderSettings& settings,
                    const Budget& budget,
                    const JoinedObjects& joined,
                    TransportChoice transport);

} // namespace renderer
