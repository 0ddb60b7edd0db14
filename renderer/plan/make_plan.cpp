#include "renderer/math/floating_point_mode.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/check_description.h"
#include "renderer/plan/choices.h"
#include "renderer/plan/plan.h"

namespace renderer {

std::variant<Plan, std::vector<Fault>> make_plan(const AssumedScene& scene,
                                                 std::span<const MeshFacts> meshes,
                                                 const RenderSettings& settings,
                                                 const Limits& limits)
{
    const DefaultFloatingPoint whatever_the_caller_has;
    const SceneDescription& description = scene.description;
    FaultList faults;
    check_description(description, meshes, faults);
    check_settings(settings, faults);
    check_budget(predict(description, meshes, settings), limits, faults);
    if (!faults.empty()) return faults.take();

    Plan plan;
    plan.transport = TransportType::direct;
    plan.models = explain(scene, meshes);
    return plan;
}

} // namespace renderer
