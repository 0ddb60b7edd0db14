// budget: what a render will cost, predicted before anything is allocated.
//
// Units   bytes and rays; upper bounds.
#pragma once

#include "renderer/description/fault.h"
#include "renderer/description/limits.h"
#include "renderer/description/scene_description.h"
#include "renderer/description/settings.h"
#include "renderer/plan/plan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace renderer {

struct Budget {
    std::uint64_t pixels = 0;     // of the region that is rendered
    std::uint64_t triangles = 0;  // each mesh counted once
    std::uint64_t film_bytes = 0; // sums, the finished picture, its developed form
    std::uint64_t mesh_bytes = 0; // vertices, indices, BVHs
    std::uint64_t camera_rays = 0;
    std::uint64_t shadow_rays = 0;
};

Budget
predict(const SceneDescription& scene, std::span<const MeshFacts> meshes, const RenderSettings& settings);

// One fault for each limit that the budget passes, with the number and the limit.
std::vector<Fault> check_budget(const Budget& budget, const Limits& limits);

} // namespace renderer
