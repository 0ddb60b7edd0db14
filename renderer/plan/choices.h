// explain: the plan in words for the user: every model used and every one left out, each with its reason.
#pragma once

#include "renderer/description/report.h"
#include "renderer/plan/plan.h"

#include <span>

namespace renderer {

// Does this object interpolate normals: its mesh has them and it is not asked to be flat?
bool shades_smoothly(const ObjectDescription& object, std::span<const MeshFacts> meshes);

ModelReport explain(const AssumedScene& scene, std::span<const MeshFacts> meshes, const Plan& plan);

} // namespace renderer
