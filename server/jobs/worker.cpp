#include "server/jobs/worker.h"

#include "server/jobs/clock.h"
#include "server/jobs/deadline.h"
#include "server/jobs/job_problems.h"
#include "server/jobs/job_run.h"
#include "server/jobs/sharing.h"
#include "server/jobs/submission.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <new>
#include <utility>

namespace server {

namespace {

// One process owns the store, and a lease dies with it: no lease runs out while its worker lives.
constexpr std::chrono::hours kLeaseTime{24 * 365};
constexpr std::chrono::hours kLongWait{1};

} // namespace

void Worker::start()
{
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void Worker::stop()
{
    if (!thread_.joinable()) return;
    thread_.request_stop();
    rooms_.live.stop_all(StopCause::drain);
    thread_.join();
}

void Worker::run(const std::stop_token& stop)
{
    while (!stop.stop_requested()) {
        try {
            const std::vector<Lease> leases = rooms_.store.claim("local", 1, kLeaseTime);
            if (leases.empty()) rooms_.store.wait_work(kLongWait, stop);
            for (const Lease& lease : leases)
                take(lease, stop);
        } catch (const std::exception& error) {
            ++failures_;
            rooms_.log.write(LogLevel::error, "claim_failed", {{"what", error.what()}});
        }
        if (failures_ != 0) rest(stop);
    }
}

void Worker::take(const Lease& lease, const std::stop_token& stop)
{
    const std::int64_t now = unix_ms();
    const LiveJobs::Begun begun = rooms_.live.begin(lease.job, now);
    if (begun.outcome) { // another job's result became its own while it waited
        rooms_.keeper.keep({{}, lease, begun.outcome, true});
        return;
    }
    Task task{lease, {}, begun.stop, now};
    // A stop between claim and begin found no job to stop.
    if (stop.stop_requested()) return give_back(task);
    try {
        std::optional<JobRecord> record = rooms_.store.get({}, lease.job);
        if (!record) return rooms_.live.forget(lease.job);
        task.record = std::move(*record);
        work_on(task);
    } catch (const std::exception& error) {
        retry_later(task, error.what());
    }
}

// Whatever is thrown while a job runs ends here.
void Worker::work_on(const Task& task)
{
    const JobId& id = task.lease.job;
    try {
        attempt(task);
        failures_ = 0;
    } catch (const StoreError& error) {
        retry_later(task, error.what());
    } catch (const std::bad_alloc&) {
        rooms_.log.write(LogLevel::error, "job_out_of_memory", {{"job", id}});
        end_failed(task, out_of_memory_problem(id));
    } catch (const std::exception& error) {
        rooms_.log.write(LogLevel::error, "job_broke", {{"job", id}, {"what", error.what()}});
        end_failed(task, internal_problem(id));
    }
}

void Worker::attempt(const Task& task)
{
    const JobRecord& record = task.record;
    if (record.cancel_requested) return end(task, {.phase = LivePhase::canceled});
    if (record.attempts > kMaxAttempts)
        return end_failed(task, too_many_attempts_problem(record.id, record.attempts));
    auto read = api::read_job(record.spec.request_json, context_of_stored(rooms_.limits));
    if (auto* problem = std::get_if<api::ProblemDetails>(&read)) return end_failed(task, std::move(*problem));
    const auto& request = std::get<api::JobRequest>(read);

    const LiveJobs::Described known =
        rooms_.live.describe(record.id, sharing_of(request, record.spec.render_key, record.spec.no_cache));
    if (known.outcome) return rooms_.keeper.keep({{}, task.lease, known.outcome, true});
    if (end_with_known_result(task, known.sharing)) return;
    run_request(task, request);
}

bool Worker::end_with_known_result(const Task& task, const Sharing& sharing)
{
    if (!may_reuse_stored(sharing) || !rooms_.store.find_picture({}, sharing.render_key)) return false;
    LiveJobs::Settled settled;
    {
        const auto hold = rooms_.keeper.hold_results();
        std::optional<JobResult> known = rooms_.store.find_result({}, sharing.render_key);
        if (!known || !rooms_.blobs.has(BlobStore::Kind::result, known->image_digest)) return false;
        JobOutcome outcome{.phase = LivePhase::succeeded};
        outcome.result = std::move(*known);
        outcome.finished_ms = unix_ms();
        settled = rooms_.live.finish(task.lease.job, std::move(outcome), true); // from here on it is needed
    }
    rooms_.keeper.keep({settled.followers, task.lease, settled.outcome, true});
    return true;
}

void Worker::run_request(const Task& task, const api::JobRequest& request)
{
    const JobId& id = task.lease.job;
    const Deadline deadline(request.time_limit_s,
                            [this, &id] { rooms_.live.request_stop(id, StopCause::time_limit); });
    const JobRun run{.id = id,
                     .render_key = task.record.spec.render_key,
                     .request = request,
                     .stop = task.stop,
                     .running = [this, &id] { rooms_.live.set_running(id); },
                     .progress =
                         [this, &id](const renderer::RenderProgress& progress) {
                             rooms_.live.set_progress(id, progress.fraction, progress.samples);
                         }};
    auto ended = run_job(run, {rooms_.imports, pool_, rooms_.limits, &caches_});
    if (auto* outcome = std::get_if<JobOutcome>(&ended))
        end_rendered(task, std::move(*outcome));
    else if (auto* error = std::get_if<api::ProblemDetails>(&ended))
        end_failed(task, std::move(*error));
    else
        end_stopped(task, request);
}

void Worker::end_rendered(const Task& task, JobOutcome outcome)
{
    const std::uint64_t bytes = stored_bytes_of(outcome);
    if (bytes > rooms_.limits.total_result_bytes)
        return end_failed(task, result_too_large_problem(bytes, rooms_.limits));
    end(task, std::move(outcome));
}

void Worker::end_stopped(const Task& task, const api::JobRequest& request)
{
    switch (rooms_.live.stop_cause(task.lease.job)) {
    case StopCause::cancel:
        return end(task, {.phase = LivePhase::canceled});
    case StopCause::time_limit:
        return end_failed(task, time_limit_problem(request.time_limit_s.value_or(0)));
    case StopCause::drain:
        return give_back(task);
    case StopCause::none:
        return end_failed(task, internal_problem(task.lease.job)); // nobody asked for it
    }
}

void Worker::end_failed(const Task& task, api::ProblemDetails error)
{
    JobOutcome outcome{.phase = LivePhase::failed};
    outcome.error = std::move(error);
    end(task, std::move(outcome));
}

void Worker::end(const Task& task, JobOutcome outcome)
{
    outcome.finished_ms = unix_ms();
    const LiveJobs::Settled settled = rooms_.live.finish(task.lease.job, std::move(outcome));
    const JobOutcome& published = *settled.outcome;
    const double seconds = static_cast<double>(published.finished_ms - task.started_ms) / 1e3;
    const char* event = published.phase == LivePhase::succeeded ? "job_succeeded"
                        : published.phase == LivePhase::failed  ? "job_failed"
                                                                : "job_canceled";
    rooms_.log.write(LogLevel::info,
                     event,
                     {{"job", task.lease.job},
                      {"seconds", seconds},
                      {"code", published.error.code},
                      {"followers", static_cast<std::int64_t>(settled.followers.size())}});
    rooms_.estimate.took(seconds);
    rooms_.keeper.keep({settled.followers, task.lease, settled.outcome});
}

// The world failed, not the job.
void Worker::retry_later(const Task& task, const std::string& what)
{
    ++failures_;
    const JobId& id = task.lease.job;
    rooms_.log.write(LogLevel::error, "job_interrupted", {{"job", id}, {"what", what}});
    try {
        rooms_.store.fail(task.lease, failure_of(internal_problem(id)), true, unix_ms());
        const std::optional<JobRecord> record = rooms_.store.find({}, id);
        if (record && record->state == StoredState::queued)
            rooms_.live.requeue(id);
        else
            rooms_.live.forget(id);
    } catch (const std::exception& error) { // not even that: the keeper tries until the store takes it
        rooms_.log.write(LogLevel::error, "retry_not_stored", {{"job", id}, {"what", error.what()}});
        end_failed(task, internal_problem(id));
    }
}

void Worker::give_back(const Task& task)
{
    try {
        rooms_.store.release({task.lease});
    } catch (const std::exception& error) { // the next start finds the lease void
        rooms_.log.write(
            LogLevel::error, "lease_not_released", {{"job", task.lease.job}, {"what", error.what()}});
    }
    rooms_.live.requeue(task.lease.job);
}

// After a failure of the disk or the store: longer after each in a row, so that five attempts are not five at
// once.
void Worker::rest(const std::stop_token& stop)
{
    const auto pause = std::chrono::milliseconds(50) * (1u << std::min(failures_, 8u));
    std::unique_lock lock(rest_mutex_);
    rest_over_.wait_for(lock, stop, pause, [] { return false; });
}

} // namespace server
