#include "server/jobs/job_run.h"

#include "api/provenance.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/film/develop.h"
#include "renderer/plan/plan.h"
#include "renderer/scene/scene.h"
#include "server/jobs/job_problems.h"
#include "server/store/blob_store.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

namespace server {

namespace {

using Meshes = std::vector<std::shared_ptr<const renderer::PreparedMesh>>;

std::variant<Meshes, api::ProblemDetails, StoppedRun> import_meshes(const JobRun& run, const RunTools& tools)
{
    const renderer::SceneDescription& scene = run.request.scene;
    Meshes meshes;
    std::vector<renderer::Fault> faults;
    for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) {
        auto answer = tools.imports.import({.name = scene.meshes[i].name,
                                            .digest = scene.meshes[i].digest,
                                            .files = run.request.files,
                                            .split = run.request.settings.acceleration.split},
                                           tools.pool,
                                           run.stop);
        if (const auto* failure = std::get_if<ImportFailure>(&answer)) {
            const std::vector<renderer::Fault> found = faults_of(*failure, scene, i);
            faults.insert(faults.end(), found.begin(), found.end());
            continue;
        }
        auto& asset = std::get<PreparedAsset>(answer);
        if (!asset.mesh) return StoppedRun{};
        meshes.push_back(std::move(asset.mesh));
    }
    if (!faults.empty()) return faults_problem(faults);
    return meshes;
}

double aspect_of(const renderer::ImageSettings& image)
{
    return static_cast<double>(image.width_px) / image.height_px;
}

JobOutcome picture_of(const JobRun& run, renderer::AssumedScene scene, renderer::RenderResult rendered)
{
    std::vector<renderer::PngText> texts;
    for (auto& [keyword, text] :
         api::provenance_of(run.request, run.render_key, rendered.report.accuracy.samples))
        texts.push_back({keyword, text});
    const std::vector<std::uint8_t> png =
        renderer::encode_png(renderer::develop(rendered.film.mean(), run.request.settings.image), texts);
    auto bytes = std::make_shared<std::vector<std::byte>>(png.size());
    std::memcpy(bytes->data(), png.data(), png.size());

    JobOutcome outcome;
    outcome.phase = LivePhase::succeeded;
    outcome.result.image_digest = digest_of(std::span<const std::byte>(*bytes));
    outcome.result.report_json =
        api::write_report(rendered.report, run.id, run.render_key, run.request.settings.quality);
    api::JobRequest executed = run.request;
    executed.scene = std::move(scene.description);
    outcome.result.scene_json = api::write_job(executed);
    outcome.result.samples = rendered.report.accuracy.samples;
    outcome.result.reusable = rendered.report.accuracy.stop_reason == renderer::StopReason::samples;
    outcome.non_finite_samples = rendered.report.numerics.non_finite_samples;
    outcome.png = std::move(bytes);
    return outcome;
}

bool fails_on(const api::JobRequest& request, const char* what)
{
    return std::find(request.fail_on.begin(), request.fail_on.end(), what) != request.fail_on.end();
}

} // namespace

std::variant<JobOutcome, api::ProblemDetails, StoppedRun> run_job(const JobRun& run, const RunTools& tools)
{
    using Clock = std::chrono::steady_clock;
    const auto begun = Clock::now();
    const renderer::RenderSettings& settings = run.request.settings;

    auto imported = import_meshes(run, tools);
    if (auto* problem = std::get_if<api::ProblemDetails>(&imported)) return std::move(*problem);
    if (std::holds_alternative<StoppedRun>(imported)) return StoppedRun{};
    const Meshes meshes = std::move(std::get<Meshes>(imported));

    std::vector<renderer::MeshFacts> facts;
    facts.reserve(meshes.size());
    for (const auto& mesh : meshes)
        facts.push_back(renderer::facts_of(renderer::mesh_of(*mesh)));
    renderer::AssumedScene scene =
        renderer::assume_defaults(run.request.scene, facts, aspect_of(settings.image));
    auto planned = renderer::make_plan(scene, facts, settings, tools.limits);
    if (const auto* faults = std::get_if<std::vector<renderer::Fault>>(&planned))
        return faults_problem(*faults);
    const renderer::Plan plan = std::move(std::get<renderer::Plan>(planned));
    const auto prepared = renderer::prepare(scene, plan, meshes, settings, tools.pool);
    if (run.stop.stop_requested()) return StoppedRun{};

    run.running();
    const double prepare_s = std::chrono::duration<double>(Clock::now() - begun).count();
    auto rendered = renderer::render(*prepared, plan, settings, tools.pool, run.stop, run.progress);
    if (!rendered) return StoppedRun{};
    rendered->report.timing.prepare_s = prepare_s;
    const std::uint64_t non_finite = rendered->report.numerics.non_finite_samples;
    if (non_finite != 0 && fails_on(run.request, "non_finite")) return non_finite_problem(non_finite);
    return picture_of(run, std::move(scene), std::move(*rendered));
}

} // namespace server
