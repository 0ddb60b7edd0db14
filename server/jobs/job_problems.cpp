#include "server/jobs/job_problems.h"

#include "api/words/limit_words.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>
#include <variant>

namespace server {

namespace {

api::ProblemDetails problem(int status, const char* code, std::string detail, bool retryable)
{
    return {.status = status,
            .code = code,
            .detail = std::move(detail),
            .retryable = retryable,
            .request_id = {},
            .errors = {}};
}

} // namespace

api::ProblemDetails draining_problem()
{
    return problem(503, "draining", "the service is shutting down; send the job again when it is back", true);
}

api::ProblemDetails storage_full_problem()
{
    return problem(503,
                   "storage_full",
                   "the service's disk is full, so the job was not accepted; try again later",
                   true);
}

api::ProblemDetails results_full_problem(std::uint64_t limit)
{
    return problem(503,
                   "storage_full",
                   "all jobs together would be over the limit total_result_bytes, " + std::to_string(limit) +
                       " bytes, and those stored are not finished; try again later, or " +
                       api::raise_words("total_result_bytes"),
                   true);
}

api::ProblemDetails queue_full_problem(std::uint64_t limit)
{
    return problem(429,
                   "queue_full",
                   std::to_string(limit) +
                       " jobs wait already, which is the limit queue_jobs; try again later, or " +
                       api::raise_words("queue_jobs"),
                   true);
}

api::ProblemDetails key_reused_problem()
{
    return problem(422,
                   "idempotency_key_reuse",
                   "this Idempotency-Key was sent before with another body; use a new key for a new job",
                   false);
}

api::ProblemDetails bad_cursor_problem()
{
    return api::problem_from_faults(
        422,
        "invalid_query",
        {{"", "invalid_parameter", "cursor is what next_cursor of the page before said, and nothing else"}});
}

api::ProblemDetails not_found_problem(const JobId& id)
{
    return problem(404, "not_found", "there is no job " + id, false);
}

api::ProblemDetails still_running_problem(const JobId& id)
{
    return problem(504,
                   "still_running",
                   "job " + id + " is not finished; ask again, or wait with Prefer: wait=60",
                   true);
}

api::ProblemDetails still_ending_problem(const JobId& id)
{
    return problem(503,
                   "still_ending",
                   "job " + id + " has ended or was canceled, but is not yet put away; delete it again",
                   true);
}

api::ProblemDetails render_failed_problem(const JobId& id, const api::ProblemDetails* why)
{
    if (why == nullptr)
        return problem(409, "render_failed", "job " + id + " was canceled: it has no picture", false);
    api::ProblemDetails failed =
        problem(409, "render_failed", "job " + id + " failed: " + why->detail, false);
    failed.errors = why->errors;
    return failed;
}

api::ProblemDetails expired_problem(const JobId& id)
{
    return problem(410,
                   "expired",
                   "the result of job " + id +
                       " is no longer kept; submit it again, its scene is still at /v1/jobs/" + id + "/scene",
                   false);
}

api::ProblemDetails renders_again_problem(const JobId& id)
{
    return problem(
        504,
        "still_running",
        "the stored picture of job " + id +
            " was lost or damaged, so the job is queued and renders again; ask again, or wait with "
            "Prefer: wait=60",
        true);
}

api::ProblemDetails picture_lost_problem(const JobId& id, const std::string& asset)
{
    return problem(500,
                   "result_damaged",
                   "the stored picture of job " + id + " was lost or damaged, and " + asset +
                       ", from which it would render again, is not here: PUT /v1/assets/" + asset +
                       ", then ask again",
                   true);
}

api::ProblemDetails png_alone_problem(const JobId& id)
{
    return problem(
        406,
        "not_acceptable",
        "job " + id +
            " was rendered by an older build, which kept its PNG alone: Accept: image/png, or submit "
            "the scene again for other formats",
        false);
}

api::ProblemDetails format_too_small_problem(renderer::PictureFormat format)
{
    const renderer::PictureFormatEntry& entry = entry_of(format);
    return problem(406,
                   "not_acceptable",
                   std::string(entry.media_type) + " holds at most " + std::to_string(entry.most_side_px) +
                       " pixels a side, and this picture has more: Accept: image/png",
                   false);
}

api::ProblemDetails no_such_layer_problem(const JobId& id, renderer::Layer layer, renderer::LayerSet asked)
{
    const std::string names = names_of(asked), name(entry_of(layer).name);
    return problem(404,
                   "not_found",
                   "job " + id + " was not asked for the layer " + name + " (" +
                       (names.empty() ? "for none" : "for " + names) +
                       "): submit the scene again with it in image.layers: {\"image\": {\"layers\": [\"" +
                       name + "\"]}}",
                   false);
}

api::ProblemDetails result_too_large_problem(std::uint64_t bytes, const renderer::Limits& limits)
{
    return api::problem_from_faults(
        422, "over_limit", {api::over_limit("/image", "total_result_bytes", bytes, limits)});
}

api::ProblemDetails time_limit_problem(double limit_s)
{
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%g", limit_s);
    return problem(
        422,
        "time_limit",
        std::string("the job took longer than its limits.time_s, ") + seconds +
            " s; raise it, ask for fewer samples, or use quality.time_s for the best picture in that time",
        false);
}

api::ProblemDetails non_finite_problem(std::uint64_t samples)
{
    return problem(422,
                   "non_finite",
                   std::to_string(samples) + " samples were not finite, and fail_on names non_finite",
                   false);
}

api::ProblemDetails too_many_attempts_problem(const JobId& id, std::uint32_t attempts)
{
    return problem(
        500,
        "too_many_attempts",
        "the service stopped " + std::to_string(attempts - 1) +
            " times while it worked on this job, so it is not tried again; its log tells more under " + id,
        false);
}

api::ProblemDetails out_of_memory_problem(const JobId& id)
{
    return problem(500,
                   "out_of_memory",
                   "the service ran out of memory on job " + id + "; a smaller picture or mesh may fit",
                   true);
}

api::ProblemDetails internal_problem(const JobId& id)
{
    return problem(500,
                   "internal",
                   "the service failed while it worked on the job; its log tells more under " + id,
                   true);
}

api::ProblemDetails faults_problem(std::vector<renderer::Fault> faults)
{
    const bool over_limit = std::all_of(faults.begin(), faults.end(), [](const renderer::Fault& fault) {
        return fault.code == "over_limit";
    });
    std::vector<api::Problem> errors;
    errors.reserve(faults.size());
    for (renderer::Fault& fault : faults)
        errors.push_back({std::move(fault.pointer), std::move(fault.code), std::move(fault.detail)});
    return api::problem_from_faults(422, over_limit ? "over_limit" : "invalid_scene", std::move(errors));
}

JobFailure failure_of(const api::ProblemDetails& problem)
{
    api::ProblemDetails summary = problem;
    summary.errors.clear();
    return {api::write_problem(summary), api::write_problem(problem)};
}

void add_faults(const FailedMeshes& failed,
                const renderer::SceneDescription& scene,
                renderer::FaultList& faults)
{
    if (failed.empty()) return;
    std::set<std::uint32_t> told;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const auto* shape = std::get_if<renderer::MeshShape>(&scene.objects[i].shape);
        const auto failure = shape != nullptr ? failed.find(shape->mesh) : failed.end();
        if (failure == failed.end()) continue;
        faults.add(
            {"/scene/objects/" + std::to_string(i) + "/mesh", failure->second.code, failure->second.detail});
        told.insert(failure->first);
    }
    for (const auto& [mesh, failure] : failed) // named, but by no object
        if (!told.contains(mesh)) faults.add({"/files", failure.code, failure.detail});
}

void add_fault(const renderer::ImageReference& image, ImportFailure failure, renderer::FaultList& faults)
{
    faults.add({image.pointer, std::move(failure.code), std::move(failure.detail)});
}

} // namespace server
