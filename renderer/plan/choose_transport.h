// choose_transport: how light is followed: what the description asks for, or the cheapest way that leaves out nothing
// that its models say.
//
// A scene of the classic empirical models alone (Phong, mirrors, smooth glass) under lights without extent is what
// its definition says: direct light, and Whitted's tree where there are mirrors or glass; no noise but at edges. Matter
// that scatters as real matter does lights other matter: a path, unless nothing is there to be lit.
#pragma once

#include "renderer/plan/plan.h"

#include <span>
#include <vector>

namespace renderer {

struct TransportChoice {
    Integrator integrator = Integrator::direct;
    std::uint32_t max_depth = 1;
    bool picks_lights = false;
    std::vector<ModelChoice> used, skipped; // what was chosen, and what that leaves out
};

TransportChoice choose_transport(const SceneDescription& scene, std::span<const MeshFacts> meshes);

} // namespace renderer
