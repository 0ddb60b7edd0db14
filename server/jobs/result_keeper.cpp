#include "server/jobs/result_keeper.h"

#include "server/jobs/clock.h"
#include "server/jobs/job_problems.h"
#include "server/store/store_rules.h"

#include <algorithm>
#include <exception>
#include <set>
#include <utility>

namespace server {

namespace {

constexpr std::size_t kMostWaiting = 8;
constexpr std::uint64_t kMostWaitingBytes = 512u << 20;
constexpr std::chrono::seconds kRetryAfter{1};

} // namespace

void ResultKeeper::start()
{
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void ResultKeeper::stop_waiting()
{
    const std::lock_guard lock(mutex_);
    closing_ = true;
    change_.notify_all();
}

void ResultKeeper::stop()
{
    if (!thread_.joinable()) return;
    thread_.request_stop();
    thread_.join();
}

void ResultKeeper::keep(KeptOutcome kept)
{
    std::unique_lock lock(mutex_);
    const JobOutcome& outcome = *kept.outcome;
    if (outcome.kept) {
        rooms_.pictures.put(picture_key(outcome.result.image_digest, {}), {outcome.png, outcome.png_digest});
        if (kept.lease) change_.wait(lock, [&] { return closing_ || has_room_for(outcome); });
    }
    waiting_.push_back(std::move(kept));
    lock.unlock();
    change_.notify_all();
}

// One is taken whatever its size.
bool ResultKeeper::has_room_for(const JobOutcome& outcome) const
{
    std::uint64_t bytes = stored_bytes_of(outcome);
    for (const KeptOutcome& kept : waiting_)
        bytes += stored_bytes_of(*kept.outcome);
    return waiting_.empty() || (waiting_.size() < kMostWaiting && bytes <= kMostWaitingBytes);
}

void ResultKeeper::run(const std::stop_token& stop)
{
    const auto interval = std::clamp<std::chrono::seconds>(
        rooms_.retention / 10, std::chrono::seconds(1), std::chrono::seconds(60));
    auto next_sweep = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested() || !waiting_.empty()) {
        if (waiting_.empty()) {
            change_.wait_until(lock, stop, next_sweep, [&] { return !waiting_.empty(); });
            if (waiting_.empty() && !stop.stop_requested() &&
                std::chrono::steady_clock::now() >= next_sweep) {
                lock.unlock();
                sweep();
                lock.lock();
                next_sweep = std::chrono::steady_clock::now() + interval;
            }
            continue;
        }
        const KeptOutcome kept = waiting_.front();
        lock.unlock();
        const bool done = try_keep(kept);
        if (!done && stop.stop_requested()) give_back(kept);
        lock.lock();
        if (done || stop.stop_requested()) {
            waiting_.pop_front();
            change_.notify_all();
        } else {
            change_.wait_for(lock, stop, kRetryAfter, [] { return false; });
        }
    }
}

bool ResultKeeper::try_keep(const KeptOutcome& kept)
{
    const std::string id = kept.lease            ? kept.lease->job
                           : kept.queued.empty() ? std::string()
                                                 : kept.queued.front();
    try {
        store_outcome(kept);
        return true;
    } catch (const std::exception& error) {
        rooms_.log.write(LogLevel::error, "result_not_stored", {{"job", id}, {"what", error.what()}});
        return false;
    }
}

void ResultKeeper::store_outcome(const KeptOutcome& kept)
{
    const JobOutcome& outcome = *kept.outcome;
    {
        const std::lock_guard results(results_);
        if (outcome.kept && !fits(stored_bytes_of(outcome))) free_room(stored_bytes_of(outcome));
        if (outcome.kept) rooms_.blobs.put(BlobStore::Kind::result, *outcome.kept);
        if (kept.lease) store_lease(kept, *kept.lease);
        for (const JobId& id : kept.queued)
            rooms_.store.complete_queued(id, outcome.result, outcome.finished_ms);
    }
    if (kept.lease) rooms_.live.forget(kept.lease->job);
    for (const JobId& id : kept.queued)
        forget_if_final(id);
}

void ResultKeeper::store_lease(const KeptOutcome& kept, const Lease& lease)
{
    const JobOutcome& outcome = *kept.outcome;
    bool ours = false;
    switch (outcome.phase) {
    case LivePhase::succeeded:
        ours = rooms_.store.complete(lease, outcome.result, outcome.finished_ms, kept.reused);
        break;
    case LivePhase::failed:
        ours = rooms_.store.fail(lease, failure_of(outcome.error), false, outcome.finished_ms);
        break;
    case LivePhase::canceled:
        ours = rooms_.store.confirm_cancel(lease, outcome.finished_ms);
        break;
    case LivePhase::queued:
    case LivePhase::preparing:
    case LivePhase::running:
    case LivePhase::canceling:
        break; // no outcome has these
    }
    if (!ours) rooms_.log.write(LogLevel::warning, "lease_lost", {{"job", lease.job}});
}

// A follower that was claimed meanwhile keeps its entry: the worker finds the outcome in it and brings the
// lease.
void ResultKeeper::forget_if_final(const JobId& id)
{
    const std::optional<JobRecord> record = rooms_.store.find({}, id);
    if (!record || is_final(record->state)) rooms_.live.forget(id);
}

void ResultKeeper::give_back(const KeptOutcome& kept)
{
    if (!kept.lease) return; // queued ones are queued still
    try {
        rooms_.store.release({*kept.lease});
    } catch (const std::exception& error) { // then the next start finds the lease void
        rooms_.log.write(
            LogLevel::error, "lease_not_released", {{"job", kept.lease->job}, {"what", error.what()}});
    }
}

void ResultKeeper::sweep()
{
    try {
        const std::size_t expired =
            rooms_.store.sweep(unix_ms() - std::chrono::milliseconds(rooms_.retention).count());
        collect_all();
        make_room(0);
        if (expired != 0) {
            rooms_.log.write(
                LogLevel::info, "results_expired", {{"jobs", static_cast<std::int64_t>(expired)}});
            rooms_.live.forget({}); // wakes who waits: a final job changed
        }
    } catch (const std::exception& error) {
        rooms_.log.write(LogLevel::error, "sweep_failed", {{"what", error.what()}});
    }
}

// The order matters: an outcome goes from live to store, so who reads live first cannot miss it.
void ResultKeeper::collect_all()
{
    const std::lock_guard results(results_);
    const std::vector<std::string> stored = rooms_.blobs.list(BlobStore::Kind::result);
    if (stored.empty()) return;
    const std::vector<std::string> live = rooms_.live.image_digests();
    const std::vector<std::string> shown = rooms_.store.pictures();
    std::set<std::string> needed(live.begin(), live.end());
    needed.insert(shown.begin(), shown.end());
    for (const std::string& digest : stored)
        if (!needed.contains(digest)) rooms_.blobs.remove(BlobStore::Kind::result, digest);
}

bool ResultKeeper::is_needed(const std::string& digest)
{
    const std::vector<std::string> live = rooms_.live.image_digests();
    return std::find(live.begin(), live.end(), digest) != live.end() || rooms_.store.shows(digest);
}

void ResultKeeper::collect(const std::string& image_digest)
{
    const std::lock_guard results(results_);
    if (!is_needed(image_digest)) rooms_.blobs.remove(BlobStore::Kind::result, image_digest);
}

} // namespace server
