#include "renderer/math/floating_point_mode.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/check_description.h"
#include "renderer/plan/choices.h"
#include "renderer/plan/choose_sky.h"
#include "renderer/plan/choose_transport.h"
#include "renderer/plan/explain_numerics.h"
#include "renderer/plan/joined_objects.h"
#include "renderer/plan/mesh_trees.h"
#include "renderer/plan/plan.h"
#include "renderer/plan/predict_cost.h"
#include "renderer/plan/world_frame.h"

#include <utility>

namespace renderer {

std::variant<Plan, std::vector<Fault>> make_plan(const AssumedScene& scene,
                                                 std::span<const MeshFacts> meshes,
                                                 const RenderSettings& settings,
                                                 const Limits& limits,
                                                 std::span<const ImageFacts> images)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    const SceneDescription& description = scene.description;
    FaultList faults;
    check_description(description, meshes, faults);
    check_settings(settings, faults);
    const Budget budget = predict(description, meshes, settings, images);
    check_budget(budget, limits, faults);
    if (!faults.empty()) return faults.take();

    Plan plan;
    TransportChoice transport = choose_transport(description, meshes);
    plan.integrator = transport.integrator;
    plan.max_depth = transport.max_depth;
    if (description.transport.clamp) plan.clamp = static_cast<float>(*description.transport.clamp);
    plan.picks_lights = transport.picks_lights;
    plan.world_origin = choose_world_origin(description, meshes);
    plan.joined = choose_joined(description, meshes, plan.world_origin);
    plan.precision = corner_precision(description, meshes);
    plan.layers = settings.image.layers;
    const MeshTrees trees(description, settings);
    for (const MeshFacts& mesh : meshes)
        plan.mesh_trees.push_back(trees.of(mesh.triangles));
    plan.prediction = predict_cost(description, settings, budget, transport);
    plan.models = explain(scene, meshes, settings, budget, plan.joined, std::move(transport));
    trees.explain(meshes, plan.models);
    plan.sky = choose_sky(description, meshes, plan.integrator, plan.models);
    plan.exposure_ev = choose_exposure(settings.image, description, plan.integrator, plan.models);
    explain_numerics(description, meshes, settings.image, plan.world_origin, plan.models);
    return plan;
}

} // namespace renderer
