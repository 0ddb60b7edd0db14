#include "server/jobs/job_run.h"

#include "api/provenance.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/film/encode_picture.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/mesh_trees.h"
#include "renderer/plan/plan.h"
#include "renderer/scene/scene.h"
#include "server/jobs/job_problems.h"
#include "server/jobs/kept_picture.h"
#include "server/store/blob_store.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace server {

namespace {

using Meshes = std::vector<std::shared_ptr<const renderer::PreparedMesh>>;

struct Imported {
    Meshes meshes;
    std::vector<renderer::MeshFacts> facts; // one a mesh
    std::vector<ImportedPixels> images;
    std::vector<renderer::ImageFacts> image_facts; // one a picture
    std::vector<std::string> notes;                // of the importers, with the mesh's name
    std::size_t more_notes = 0;                    // that are counted only
};

void add_notes(const std::string& mesh, const std::vector<std::string>& notes, Imported& imported)
{
    constexpr std::size_t kMostNotes = 1000; // of a job: one mesh may go by thousands of names
    for (const std::string& note : notes) {
        if (imported.notes.size() < kMostNotes)
            imported.notes.push_back(std::string(mesh).append(": ").append(note));
        else
            ++imported.more_notes;
    }
}

// The picture's faults are told; false only if the run was stopped.
bool import_pictures(const JobRun& run,
                     const RunTools& tools,
                     renderer::Budget& budget,
                     Imported& imported,
                     renderer::FaultList& faults)
{
    for (const renderer::ImageReference& image : run.request.scene.images) {
        auto answer = tools.imports.picture(image.name, image.digest, run.stop);
        if (auto* failure = std::get_if<ImportFailure>(&answer)) {
            add_fault(image, std::move(*failure), faults);
            continue;
        }
        auto& pixels = std::get<ImportedPixels>(answer);
        if (!pixels) return false;
        imported.image_facts.push_back(renderer::facts_of(*pixels));
        imported.images.push_back(std::move(pixels));
        renderer::add_image(budget, imported.image_facts.back());
        renderer::FaultList excess;
        renderer::check_budget(budget, tools.limits, excess);
        if (excess.empty()) continue;
        for (renderer::Fault& fault : excess.take()) {
            fault.detail += ", counted up to the picture \"" + image.name + "\"";
            faults.add(std::move(fault));
        }
        break;
    }
    return true;
}

// A mesh that takes the scene over a limit is the last one: the job never holds more than that.
std::variant<Imported, api::ProblemDetails, StoppedRun> import_meshes(const JobRun& run,
                                                                      const RunTools& tools)
{
    const renderer::SceneDescription& scene = run.request.scene;
    Imported imported;
    FailedMeshes failed;
    renderer::FaultList faults;
    renderer::Budget budget = renderer::predict(scene, {}, run.request.settings);
    renderer::check_budget(budget, tools.limits, faults);
    if (!faults.empty()) return faults_problem(faults.take());
    const std::vector<renderer::MeshUse> uses =
        renderer::uses_of(scene, std::vector<renderer::MeshFacts>(scene.meshes.size()));
    const renderer::MeshTrees trees(scene, run.request.settings);
    for (std::uint32_t i = 0; i < scene.meshes.size(); ++i) {
        const auto with = [&](const renderer::MeshFacts& facts) {
            renderer::Budget sum = budget;
            renderer::add_mesh(sum, facts, uses[i], trees.of(facts.triangles));
            return sum;
        };
        auto answer =
            tools.imports.import({.name = scene.meshes[i].name,
                                  .digest = scene.meshes[i].digest,
                                  .files = run.request.files,
                                  .tree_for = [&](std::uint64_t triangles) { return trees.of(triangles); },
                                  .may_build =
                                      [&](const renderer::MeshFacts& facts) {
                                          renderer::FaultList excess;
                                          renderer::check_budget(with(facts), tools.limits, excess);
                                          return excess.empty();
                                      }},
                                 tools.pool,
                                 run.stop);
        if (auto* failure = std::get_if<ImportFailure>(&answer)) {
            failed.emplace(i, std::move(*failure));
            continue;
        }
        auto& asset = std::get<PreparedAsset>(answer);
        if (!asset.facts) return StoppedRun{};
        imported.facts.push_back(*asset.facts);
        imported.meshes.push_back(std::move(asset.mesh));
        add_notes(scene.meshes[i].name, asset.notes, imported);
        budget = with(imported.facts.back());
        renderer::FaultList excess;
        renderer::check_budget(budget, tools.limits, excess);
        if (excess.empty()) continue;
        for (renderer::Fault& fault : excess.take()) {
            fault.detail += ", counted up to the mesh \"" + scene.meshes[i].name + "\"";
            faults.add(std::move(fault));
        }
        break;
    }
    add_faults(failed, scene, faults);
    if (faults.empty() && !import_pictures(run, tools, budget, imported, faults)) return StoppedRun{};
    if (!faults.empty()) return faults_problem(faults.take());
    if (imported.more_notes)
        imported.notes.push_back("and " + std::to_string(imported.more_notes) + " notes more");
    return imported;
}

double aspect_of(const renderer::ImageSettings& image)
{
    return static_cast<double>(image.width_px) / image.height_px;
}

JobOutcome picture_of(const JobRun& run,
                      renderer::AssumedScene scene,
                      double exposure_ev,
                      renderer::RenderResult rendered)
{
    renderer::FinishedFilm finished = finish(std::move(rendered.film));
    renderer::Picture picture{.image = std::move(finished.image),
                              .layers = std::move(finished.layers),
                              .exposure_ev = exposure_ev,
                              .tone = run.request.settings.image.tone,
                              .texts = {}};
    for (auto& [keyword, text] :
         api::provenance_of(run.request, run.render_key, rendered.report.accuracy.samples))
        picture.texts.push_back({keyword, text});
    const std::vector<std::uint8_t> png = renderer::encode_picture(picture, {});
    const auto* first = reinterpret_cast<const std::byte*>(png.data());

    JobOutcome outcome;
    outcome.phase = LivePhase::succeeded;
    outcome.png = std::make_shared<const std::vector<std::byte>>(first, first + png.size());
    outcome.png_digest = digest_of(std::span<const std::byte>(*outcome.png));
    outcome.kept = std::make_shared<const std::vector<std::byte>>(pack_picture(picture, png));
    outcome.result.image_digest = digest_of(std::span<const std::byte>(*outcome.kept));
    outcome.result.report_json =
        api::write_report(rendered.report, run.id, run.render_key, run.request.settings.quality, false);
    api::JobRequest executed = run.request;
    executed.scene = std::move(scene.description);
    executed.settings.image.exposure_ev = exposure_ev;
    outcome.result.scene_json = api::write_job(executed, false);
    outcome.result.samples = rendered.report.accuracy.samples;
    outcome.result.reusable = rendered.report.accuracy.stop_reason == renderer::StopReason::samples;
    outcome.non_finite_samples = rendered.report.numerics.non_finite_samples;
    return outcome;
}

struct Planned {
    Imported imported;
    renderer::AssumedScene scene;
    renderer::Plan plan;
};

std::variant<Planned, api::ProblemDetails, StoppedRun> planned(const JobRun& run, const RunTools& tools)
{
    const renderer::RenderSettings& settings = run.request.settings;
    auto answer = import_meshes(run, tools);
    if (auto* problem = std::get_if<api::ProblemDetails>(&answer)) return std::move(*problem);
    if (std::holds_alternative<StoppedRun>(answer)) return StoppedRun{};
    Imported imported = std::move(std::get<Imported>(answer));

    renderer::AssumedScene scene =
        renderer::assume_defaults(run.request.scene, imported.facts, aspect_of(settings.image));
    auto plan = renderer::make_plan(scene, imported.facts, settings, tools.limits, imported.image_facts);
    if (auto* faults = std::get_if<std::vector<renderer::Fault>>(&plan))
        return faults_problem(std::move(*faults));
    return Planned{std::move(imported), std::move(scene), std::move(std::get<renderer::Plan>(plan))};
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

    auto answer = planned(run, tools);
    if (auto* problem = std::get_if<api::ProblemDetails>(&answer)) return std::move(*problem);
    if (std::holds_alternative<StoppedRun>(answer)) return StoppedRun{};
    auto& [imported, scene, plan] = std::get<Planned>(answer);
    const auto prepared = renderer::prepare(
        scene, plan, imported.meshes, settings, tools.pool, run.stop, imported.images, tools.caches);
    if (!prepared || run.stop.stop_requested()) return StoppedRun{};

    run.running();
    const double prepare_s = std::chrono::duration<double>(Clock::now() - begun).count();
    auto rendered = renderer::render(*prepared, plan, settings, tools.pool, run.stop, run.progress);
    if (!rendered) return StoppedRun{};
    rendered->report.timing.prepare_s = prepare_s;
    rendered->report.notes = imported.notes;
    const std::uint64_t non_finite = rendered->report.numerics.non_finite_samples;
    if (non_finite != 0 && fails_on(run.request, "non_finite")) return non_finite_problem(non_finite);
    return picture_of(run, std::move(scene), plan.exposure_ev, *std::move(rendered));
}

std::variant<renderer::PlanReport, api::ProblemDetails, StoppedRun> plan_job(const JobRun& run,
                                                                             const RunTools& tools)
{
    auto answer = planned(run, tools);
    if (auto* problem = std::get_if<api::ProblemDetails>(&answer)) return std::move(*problem);
    if (std::holds_alternative<StoppedRun>(answer)) return StoppedRun{};
    renderer::Plan& plan = std::get<Planned>(answer).plan;
    return renderer::PlanReport{std::move(plan.models), plan.prediction};
}

} // namespace server
