#include "renderer/math/floating_point_mode.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/check_description.h"
#include "renderer/plan/choices.h"
#include "renderer/plan/plan.h"

#include <algorithm>

namespace renderer {

namespace {

void append(std::vector<Fault>& all, std::vector<Fault> more)
{
    all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

// One whole mesh where its file put it: rays may go straight to its own tree.
bool needs_two_levels(const SceneDescription& scene)
{
    if (scene.objects.size() != 1) return true;
    const ObjectDescription& only = scene.objects.front();
    const auto* const mesh = std::get_if<MeshShape>(&only.shape);
    return mesh == nullptr || !mesh->part.empty() || only.world_from_object != Affine3{};
}

} // namespace

std::variant<Plan, std::vector<Fault>> make_plan(const AssumedScene& scene,
                                                 std::span<const MeshFacts> meshes,
                                                 const RenderSettings& settings,
                                                 const Limits& limits)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    const SceneDescription& description = scene.description;
    std::vector<Fault> faults = check_description(description, meshes);
    append(faults, check_settings(settings));
    const Budget budget = predict(description, meshes, settings);
    append(faults, check_budget(budget, limits));
    if (!faults.empty()) return faults;

    Plan plan;
    plan.transport = TransportType::direct;
    plan.keep_normals =
        std::any_of(description.objects.begin(),
                    description.objects.end(),
                    [&](const ObjectDescription& object) { return shades_smoothly(object, meshes); });
    plan.two_levels = needs_two_levels(description);
    plan.camera_rays = budget.camera_rays;
    plan.shadow_rays = budget.shadow_rays;
    plan.memory_bytes = budget.film_bytes + budget.mesh_bytes;
    plan.models = explain(scene, meshes, plan);
    return plan;
}

} // namespace renderer
