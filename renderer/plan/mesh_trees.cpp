#include "renderer/plan/mesh_trees.h"

#include "renderer/plan/budget.h"
#include "renderer/plan/choose_transport.h"
#include "renderer/plan/number_in_words.h"
#include "renderer/plan/predict_cost.h"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

namespace renderer {

namespace {

// What every mesh is here: its own materials are not known yet.
TransportChoice transport_of(const SceneDescription& scene)
{
    const std::vector<MeshFacts> unknown(scene.meshes.size());
    if (scene.environment || !scene.lights.empty()) return choose_transport(scene, unknown);
    SceneDescription lit = scene; // as it will be
    lit.environment = ColorEnvironment{};
    return choose_transport(lit, unknown);
}

// That run apart: bounces and, for each, about one to a light.
double scattered_rays_a_sample(const TransportChoice& transport)
{
    switch (transport.integrator) {
    case Integrator::path:
        return 2 * std::min(kUsualScatterings, static_cast<double>(transport.max_depth));
    case Integrator::ambient_occlusion:
        return 1;
    case Integrator::direct:
    case Integrator::whitted:
    case Integrator::normals:
        return 0;
    }
    return 0;
}

// Descriptions that are yet to be refused come here too.
bool names_what_is_there(const SceneDescription& scene)
{
    return std::ranges::all_of(scene.objects, [&](const ObjectDescription& object) {
        const auto* const mesh = std::get_if<MeshShape>(&object.shape);
        return (mesh == nullptr || mesh->mesh < scene.meshes.size()) &&
               (!object.material || *object.material < scene.materials.size());
    });
}

double rays_of(const SceneDescription& scene, const RenderSettings& settings)
{
    if (!names_what_is_there(scene)) return 0;
    const double rays =
        static_cast<double>(most_camera_rays(settings)) * scattered_rays_a_sample(transport_of(scene));
    return std::min(rays, most_rays_in_time(settings));
}

} // namespace

MeshTrees::MeshTrees(const SceneDescription& scene, const RenderSettings& settings)
    : asked_(settings.acceleration), scattered_rays_(rays_of(scene, settings))
{
}

MeshTree MeshTrees::of(std::uint64_t triangles) const
{
    AccelerationSettings chosen = asked_;
    if (!chosen.split)
        chosen.split = scattered_rays_ >= kRaysATriangle * static_cast<double>(triangles) ? BvhSplit::spatial
                                                                                          : BvhSplit::sah;
    return mesh_tree(chosen);
}

void MeshTrees::explain(std::span<const MeshFacts> meshes, ModelReport& report) const
{
    if (meshes.empty()) return;
    const bool is_asked = asked_.split.has_value();
    std::size_t spatial = 0;
    for (const MeshFacts& mesh : meshes)
        spatial += of(mesh.triangles) == MeshTree::wide_spatial ? 1u : 0u;
    const std::string expected =
        "about " + number_in_words(scattered_rays_) + " rays that run apart are expected, and from " +
        number_in_words(kRaysATriangle) + " a triangle on they pay for trees that take longer to build";
    if (spatial != 0)
        report.used.push_back(
            {"spatial_splits",
             (spatial == meshes.size() ? "" : std::to_string(spatial) + " of the meshes: ") +
                 (is_asked ? "`acceleration` asks for it" : expected)});
    else if (!is_asked)
        report.skipped.push_back({"spatial_splits", expected});
}

} // namespace renderer
