#include "server/jobs/submission.h"

#include "server/jobs/clock.h"
#include "server/jobs/job_problems.h"
#include "server/jobs/sharing.h"

#include <set>
#include <string_view>
#include <utility>

namespace server {

namespace {

// Meshes that were imported before and found faulty.
std::vector<renderer::Fault> known_faults(const api::JobRequest& request, const ImportService& imports)
{
    FailedMeshes failed;
    for (std::uint32_t i = 0; i < request.scene.meshes.size(); ++i) {
        auto known = imports.known_failure({.name = request.scene.meshes[i].name,
                                            .digest = request.scene.meshes[i].digest,
                                            .files = request.files});
        if (auto* failure = std::get_if<ImportFailure>(&known)) failed.emplace(i, std::move(*failure));
    }
    renderer::FaultList faults;
    add_faults(failed, request.scene, faults);
    for (const renderer::ImageReference& image : request.scene.images) {
        auto known = imports.known_failure(
            {.name = image.name, .digest = image.digest, .files = {}, .is_picture = true});
        if (auto* failure = std::get_if<ImportFailure>(&known)) add_fault(image, std::move(*failure), faults);
    }
    return faults.take();
}

// Two requests are the same if their bytes and their files are.
std::string body_digest_of(const SubmitWords& words)
{
    std::string text = digest_of(std::string_view(words.body));
    for (const auto& [name, digest] : words.part_digests)
        text.append(1, '\n').append(name).append(1, '\t').append(digest);
    return digest_of(std::string_view(text));
}

std::vector<std::string> asset_digests_of(const api::JobRequest& request)
{
    std::set<std::string> digests;
    for (const auto& [name, digest] : request.files)
        digests.insert(digest);
    for (const renderer::MeshReference& mesh : request.scene.meshes)
        digests.insert(mesh.digest);
    for (const renderer::ImageReference& image : request.scene.images)
        digests.insert(image.digest);
    return {digests.begin(), digests.end()};
}

} // namespace

std::variant<Submission, api::ProblemDetails> read_submission(const SubmitWords& words,
                                                              const renderer::Limits& limits,
                                                              const BlobStore& blobs,
                                                              const ImportService& imports)
{
    const api::ReadContext context{
        .limits = limits, .files = words.part_digests, .has_asset = [&blobs](std::string_view digest) {
            return blobs.has(BlobStore::Kind::asset, digest);
        }};
    auto read = api::read_job(words.body, context);
    if (auto* problem = std::get_if<api::ProblemDetails>(&read)) return std::move(*problem);
    const auto& request = std::get<api::JobRequest>(read);
    std::vector<renderer::Fault> faults = known_faults(request, imports);
    if (!faults.empty()) return faults_problem(std::move(faults));

    Submission submission;
    submission.sharing =
        sharing_of(request, digest_of(std::string_view(api::canonical_render_text(request))), words.no_cache);
    SubmitRequest& out = submission.request;
    out.id = make_job_id();
    out.idempotency_key = words.idempotency_key;
    out.body_digest = body_digest_of(words);
    out.spec = {.request_json = api::write_job(request, false),
                .render_key = submission.sharing.render_key,
                .asset_digests = asset_digests_of(request),
                .priority = request.priority,
                .labels = request.labels,
                .no_cache = words.no_cache,
                .layers = request.settings.image.layers.bits};
    out.allow_reuse = may_reuse_stored(submission.sharing);
    out.queue_limit = limits.queue_jobs;
    out.now_ms = unix_ms();
    return submission;
}

// The limits of JSON were held when the request came; written out with every default it is longer, and has
// more values and other depths than it had.
api::ReadContext context_of_stored(renderer::Limits limits)
{
    limits.json_bytes = limits.json_values = limits.json_depth = std::numeric_limits<std::uint64_t>::max();
    api::ReadContext context;
    context.limits = limits;
    return context;
}

} // namespace server
