#include "server/jobs/job_service.h"

#include "server/jobs/clock.h"
#include "server/jobs/job_problems.h"
#include "server/jobs/job_run.h"
#include "server/jobs/job_views.h"
#include "server/jobs/live_jobs.h"
#include "server/jobs/result_keeper.h"
#include "server/jobs/stored_pictures.h"
#include "server/jobs/submission.h"
#include "server/jobs/wait_estimate.h"
#include "server/jobs/worker.h"
#include "server/store/store_rules.h"

#include <algorithm>
#include <atomic>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <utility>

namespace server {

namespace {

constexpr std::size_t kPictureCacheBytes = 64u << 20;
constexpr std::chrono::seconds kRemovalPatience{5};
constexpr std::chrono::milliseconds kLookAgain{5};

std::chrono::seconds retention_of(const renderer::Limits& limits)
{
    constexpr std::uint64_t kForever = 100ull * 365 * 86400;
    return std::chrono::seconds(std::min(limits.retention_s, kForever));
}

} // namespace

struct JobService::State {
    State(Store& the_store, BlobStore& the_blobs, ImportService& the_imports, const JobServiceOptions& given)
        : store(the_store), blobs(the_blobs), imports(the_imports), options(given),
          keeper({the_store,
                  the_blobs,
                  live,
                  pictures,
                  given.log,
                  retention_of(given.limits),
                  given.limits.total_result_bytes}),
          worker({the_store, the_blobs, the_imports, live, keeper, estimate, given.log, given.limits},
                 given.threads),
          stored_pictures({the_store, the_blobs, live, pictures, keeper, given.log})
    {
    }

    Store& store;
    BlobStore& blobs;
    ImportService& imports;
    JobServiceOptions options;
    std::atomic<bool> draining{false};
    LiveJobs live;
    PictureCache pictures{kPictureCacheBytes};
    WaitEstimate estimate;
    ResultKeeper keeper;
    Worker worker;
    StoredPictures stored_pictures;

    std::optional<api::JobView> view(const JobId& id, const std::optional<LiveJob>& live_job);
    void end_at_once(const JobId& id, OutcomePtr outcome);
    enum class Read : std::uint8_t { picture, whole };
    std::variant<JobOutcome, api::ProblemDetails> finished(const JobId& id, Read read);
    bool use_stored_result(const std::string& render_key);
};

JobService::JobService(Store& store,
                       BlobStore& blobs,
                       ImportService& imports,
                       const JobServiceOptions& options)
    : state_(std::make_unique<State>(store, blobs, imports, options))
{
}

JobService::~JobService()
{
    stop();
}

void JobService::start()
{
    state_->keeper.start();
    state_->worker.start();
}

void JobService::stop()
{
    state_->draining = true;
    state_->live.close();
    state_->keeper.stop_waiting();
    state_->worker.stop();
    state_->keeper.stop();
}

bool JobService::draining() const
{
    return state_->draining;
}

// A result whose picture is gone or was found damaged is not for others.
bool JobService::State::use_stored_result(const std::string& render_key)
{
    const std::optional<std::string> picture = store.find_picture({}, render_key);
    if (!picture || !blobs.has(BlobStore::Kind::result, *picture)) return false;
    blobs.touch(BlobStore::Kind::result, *picture);
    return true;
}

std::variant<SubmitAnswer, api::ProblemDetails> JobService::submit(const SubmitWords& words)
{
    State& s = *state_;
    if (s.draining) return draining_problem();
    auto read = read_submission(words, s.options.limits, s.blobs, s.imports);
    if (auto* problem = std::get_if<api::ProblemDetails>(&read)) return std::move(*problem);
    auto& submission = std::get<Submission>(read);
    SubmitRequest& request = submission.request;
    request.allow_reuse = request.allow_reuse && s.use_stored_result(request.spec.render_key);
    if (!s.keeper.make_room(request.spec.request_json.size()))
        return results_full_problem(s.options.limits.total_result_bytes);
    for (const std::string& digest : request.spec.asset_digests)
        s.blobs.touch(BlobStore::Kind::asset, digest);

    const JobId id = request.id;
    const OutcomePtr outcome = s.live.add(id, std::move(submission.sharing)); // before a worker can claim it
    Submitted submitted;
    try {
        submitted = s.store.submit(request);
    } catch (const StoreError& error) {
        s.live.forget(id);
        s.options.log.write(LogLevel::error, "job_not_stored", {{"job", id}, {"what", error.what()}});
        if (error.storage_full) return storage_full_problem();
        throw;
    }
    if (submitted.status != SubmitStatus::accepted || is_final(submitted.job.state))
        s.live.forget(id);
    else if (outcome)
        s.keeper.keep({{id}, std::nullopt, outcome, true});

    switch (submitted.status) {
    case SubmitStatus::queue_full:
        return queue_full_problem(request.queue_limit);
    case SubmitStatus::key_reused:
        return key_reused_problem();
    case SubmitStatus::accepted:
    case SubmitStatus::replayed:
        break;
    }
    const LiveJobs::Snapshot now = s.live.snapshot(submitted.job.id);
    const bool waits = submitted.job.state == StoredState::queued;
    return SubmitAnswer{
        view_of(submitted.job, now.job, waits ? s.store.queue_position(submitted.job.id) : std::nullopt),
        submitted.status == SubmitStatus::replayed};
}

std::variant<std::string, api::ProblemDetails> JobService::plan(const SubmitWords& words,
                                                                const std::stop_token& stop)
{
    State& s = *state_;
    if (s.draining) return draining_problem();
    auto read = read_submission(words, s.options.limits, s.blobs, s.imports);
    if (auto* problem = std::get_if<api::ProblemDetails>(&read)) return std::move(*problem);
    const SubmitRequest& stored = std::get<Submission>(read).request;
    const auto again = api::read_job(stored.spec.request_json, context_of_stored(s.options.limits));
    if (const auto* problem = std::get_if<api::ProblemDetails>(&again)) return *problem;
    renderer::ThreadPool pool(1); // the render's own has its hands full
    const JobRun run{stored.id, stored.spec.render_key, std::get<api::JobRequest>(again), stop, {}, {}};
    auto planned = plan_job(run, {s.imports, pool, s.options.limits});
    if (auto* problem = std::get_if<api::ProblemDetails>(&planned)) return std::move(*problem);
    if (std::holds_alternative<StoppedRun>(planned)) return draining_problem();
    return api::write_plan(std::get<renderer::PlanReport>(planned));
}

std::optional<api::JobView> JobService::State::view(const JobId& id, const std::optional<LiveJob>& live_job)
{
    const std::optional<JobRecord> record = store.find({}, id);
    if (!record) return std::nullopt;
    const bool waits = record->state == StoredState::queued;
    return view_of(*record, live_job, waits ? store.queue_position(id) : std::nullopt);
}

std::optional<api::JobView> JobService::get(const JobId& id)
{
    const LiveJobs::Snapshot now = state_->live.snapshot(id);
    return state_->view(id, now.job);
}

std::optional<api::JobView>
JobService::wait(const JobId& id, std::chrono::milliseconds timeout, const std::string& known_etag)
{
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    for (;;) {
        const LiveJobs::Snapshot now = state_->live.snapshot(id);
        std::optional<api::JobView> view = state_->view(id, now.job);
        if (!view || api::is_final(view->state)) return view;
        if (!known_etag.empty() && etag_of(*view) != known_etag) return view;
        const auto until = known_etag.empty() ? LiveJobs::Until::end : LiveJobs::Until::change;
        if (!state_->live.wait(id, now.mark, deadline, until)) return get(id);
    }
}

std::variant<std::string, api::ProblemDetails> JobService::list(const ListWords& words)
{
    // As for one job, memory is read before the store: an outcome goes from there to here.
    const std::unordered_map<JobId, LiveJob> live = state_->live.all();
    ListQuery rest{.tenant = {}, .label = words.label, .cursor = words.cursor};
    if (words.state) rest.state = stored_state_of(*words.state);
    for (const auto& [id, job] : live) // that are in this state before the store knows
        if (job.phase != LivePhase::queued && words.state == state_of(job.phase)) rest.also.push_back(id);
    std::vector<api::JobView> views;
    do { // more than once where jobs of a page are in another state than the store says
        rest.limit = words.limit - static_cast<std::uint32_t>(views.size());
        const ListPage page = state_->store.list(rest);
        if (page.bad_cursor) return bad_cursor_problem();
        for (const JobRecord& record : page.jobs) {
            const auto known = live.find(record.id);
            api::JobView view = view_of(
                record, known == live.end() ? std::nullopt : std::optional(known->second), std::nullopt);
            if (!words.state || view.state == *words.state) views.push_back(std::move(view));
        }
        rest.cursor = page.next_cursor;
    } while (!rest.cursor.empty() && views.size() < words.limit);
    return api::write_job_list(views, rest.cursor);
}

std::optional<api::JobView> JobService::cancel(const JobId& id)
{
    State& s = *state_;
    const LiveJobs::Snapshot before = s.live.snapshot(id);
    if (before.job && before.job->outcome) return get(id); // it ended; only its row is on the way
    s.live.request_stop(id, StopCause::cancel);
    const std::optional<JobRecord> record = s.store.cancel({}, id, unix_ms());
    if (!record) return std::nullopt;
    if (is_final(record->state))
        s.live.forget(id);
    else
        s.live.request_stop(id, StopCause::cancel); // claimed in between
    return get(id);
}

std::optional<api::ProblemDetails> JobService::remove(const JobId& id)
{
    State& s = *state_;
    if (!cancel(id)) return not_found_problem(id);
    const auto deadline = std::chrono::steady_clock::now() + kRemovalPatience;
    while (s.live.wait_forgotten(id, deadline)) {
        const std::optional<JobRecord> record = s.store.find({}, id);
        if (!record) return not_found_problem(id);
        if (s.store.remove({}, id)) {
            s.live.forget(id); // wakes who waits for it
            if (record->result) s.keeper.collect(record->result->image_digest);
            return std::nullopt;
        }
        // Claimed, but the worker has not begun with it, so that nobody would wake us.
        if (std::chrono::steady_clock::now() > deadline) break;
        std::this_thread::sleep_for(kLookAgain);
    }
    return still_ending_problem(id);
}

std::variant<JobOutcome, api::ProblemDetails> JobService::State::finished(const JobId& id, Read read)
{
    const LiveJobs::Snapshot now = live.snapshot(id);
    const std::optional<JobRecord> record = read == Read::whole ? store.get({}, id) : store.find({}, id);
    if (!record) return not_found_problem(id);
    const api::JobView seen = view_of(*record, now.job, std::nullopt);
    switch (seen.state) {
    case api::JobState::queued:
    case api::JobState::preparing:
    case api::JobState::running:
    case api::JobState::canceling:
        return still_running_problem(id);
    case api::JobState::failed:
        return render_failed_problem(id, seen.error ? &*seen.error : nullptr);
    case api::JobState::canceled:
        return render_failed_problem(id, nullptr);
    case api::JobState::expired:
        return expired_problem(id);
    case api::JobState::succeeded:
        break;
    }
    if (!record->result) return *now.job->outcome;
    JobOutcome outcome{.phase = LivePhase::succeeded};
    outcome.result = *record->result;
    blobs.touch(BlobStore::Kind::result, outcome.result.image_digest); // whatever of it is looked at
    return outcome;
}

std::variant<EncodedPicture, api::ProblemDetails> JobService::image(const JobId& id,
                                                                    const renderer::PictureEncoding& encoding)
{
    auto ended = state_->finished(id, State::Read::picture);
    if (auto* problem = std::get_if<api::ProblemDetails>(&ended)) return std::move(*problem);
    const auto& outcome = std::get<JobOutcome>(ended);
    const std::string& digest = outcome.result.image_digest;
    if (outcome.png && encoding == renderer::PictureEncoding{})
        return EncodedPicture{outcome.png, outcome.png_digest};
    return state_->stored_pictures.get(id, digest, outcome.kept, encoding);
}

std::variant<EncodedPicture, api::ProblemDetails>
JobService::layer(const JobId& id, renderer::Layer layer, const renderer::PictureEncoding& encoding)
{
    const std::optional<JobRecord> record = state_->store.find({}, id);
    if (!record) return not_found_problem(id);
    const renderer::LayerSet asked{record->spec.layers};
    if (!asked.has(layer)) return no_such_layer_problem(id, layer, asked);
    auto ended = state_->finished(id, State::Read::picture);
    if (auto* problem = std::get_if<api::ProblemDetails>(&ended)) return std::move(*problem);
    const auto& outcome = std::get<JobOutcome>(ended);
    return state_->stored_pictures.get(id, outcome.result.image_digest, outcome.kept, encoding, layer);
}

std::variant<std::string, api::ProblemDetails> JobService::report(const JobId& id)
{
    auto ended = state_->finished(id, State::Read::whole);
    if (auto* problem = std::get_if<api::ProblemDetails>(&ended)) return std::move(*problem);
    // It was written by the job that rendered; who shares the render has it under a name of its own.
    return api::readdress_report(std::get<JobOutcome>(ended).result.report_json, id);
}

std::variant<std::string, api::ProblemDetails> JobService::scene(const JobId& id)
{
    auto ended = state_->finished(id, State::Read::whole);
    if (auto* outcome = std::get_if<JobOutcome>(&ended)) return api::indented(outcome->result.scene_json);
    const std::optional<JobRecord> record = state_->store.get({}, id);
    if (!record) return not_found_problem(id);
    return api::indented(record->spec.request_json);
}

int JobService::estimated_wait_s() const
{
    return state_->estimate.seconds();
}

std::string etag_of(const api::JobView& view)
{
    return digest_of(std::string_view(api::write_job_view(view)));
}

} // namespace server
