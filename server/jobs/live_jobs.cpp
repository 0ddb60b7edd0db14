#include "server/jobs/live_jobs.h"

#include <algorithm>
#include <utility>

namespace server {

namespace {

bool serves(const JobOutcome& outcome, const Sharing& taker)
{
    return outcome.phase == LivePhase::succeeded && taker.takes_results &&
           !(taker.fails_on_non_finite && outcome.non_finite_samples != 0);
}

bool is_active(LivePhase phase)
{
    return phase == LivePhase::preparing || phase == LivePhase::running || phase == LivePhase::canceling;
}

} // namespace

void LiveJobs::changed(Entry& entry, bool phase)
{
    entry.progress_change = ++changes_;
    if (phase) entry.phase_change = queue_changes_ = changes_;
}

void LiveJobs::index(const JobId& id, Entry& entry, Sharing sharing)
{
    if (!entry.sharing.render_key.empty()) return;
    entry.sharing = std::move(sharing);
    by_key_[entry.sharing.render_key].push_back(id);
}

bool LiveJobs::is_under_way(const std::string& render_key) const
{
    const auto same_key = by_key_.find(render_key);
    if (same_key == by_key_.end()) return false;
    return std::any_of(same_key->second.begin(), same_key->second.end(), [&](const JobId& id) {
        const LiveJob& job = jobs_.at(id).job;
        return !job.outcome && job.phase != LivePhase::canceling;
    });
}

OutcomePtr LiveJobs::published_result(const Sharing& sharing) const
{
    const auto same_key = by_key_.find(sharing.render_key);
    if (same_key == by_key_.end()) return nullptr;
    for (const JobId& other : same_key->second) {
        const OutcomePtr& outcome = jobs_.at(other).job.outcome;
        if (outcome && outcome->result.reusable && serves(*outcome, sharing)) return outcome;
    }
    return nullptr;
}

OutcomePtr LiveJobs::add(const JobId& id, Sharing sharing)
{
    const Changing changing(*this);
    OutcomePtr published = published_result(sharing);
    const bool joined = published != nullptr || (sharing.takes_results && is_under_way(sharing.render_key));
    Entry& entry = jobs_[id];
    entry.job.joined = joined;
    if (published) {
        entry.job.phase = LivePhase::succeeded;
        entry.job.outcome = published;
    }
    index(id, entry, std::move(sharing));
    changed(entry, true);
    return published;
}

LiveJobs::Begun LiveJobs::begin(const JobId& id, std::int64_t started_ms)
{
    const Changing changing(*this);
    Entry& entry = jobs_[id];
    if (entry.job.outcome) return {{}, entry.job.outcome};
    entry.stop = std::stop_source();
    entry.cause = StopCause::none;
    entry.job = LiveJob{.phase = LivePhase::preparing, .started_ms = started_ms};
    changed(entry, true);
    return {entry.stop.get_token(), nullptr};
}

LiveJobs::Described LiveJobs::describe(const JobId& id, Sharing sharing)
{
    const Changing changing(*this);
    Entry& entry = jobs_[id];
    index(id, entry, std::move(sharing));
    if (entry.job.phase != LivePhase::canceling) {
        if (const OutcomePtr published = published_result(entry.sharing)) {
            entry.job.outcome = published;
            entry.job.phase = LivePhase::succeeded;
            entry.job.joined = true;
            changed(entry, true);
        }
    }
    return {entry.sharing, entry.job.outcome};
}

void LiveJobs::set_running(const JobId& id)
{
    const Changing changing(*this);
    const auto found = jobs_.find(id);
    if (found == jobs_.end() || found->second.job.phase != LivePhase::preparing) return;
    found->second.job.phase = LivePhase::running;
    changed(found->second, true);
}

void LiveJobs::set_progress(const JobId& id, double fraction, std::uint32_t samples)
{
    const Changing changing(*this);
    const auto found = jobs_.find(id);
    if (found == jobs_.end() || !is_active(found->second.job.phase)) return;
    LiveJob& job = found->second.job;
    if (job.progress == fraction && job.samples == samples) return;
    job.progress = fraction;
    job.samples = samples;
    changed(found->second, false);
}

void LiveJobs::requeue(const JobId& id)
{
    const Changing changing(*this);
    const auto found = jobs_.find(id);
    if (found == jobs_.end() || found->second.job.outcome) return;
    found->second.job = LiveJob{};
    changed(found->second, true);
}

bool LiveJobs::request_stop(const JobId& id, StopCause cause)
{
    std::stop_source stop{std::nostopstate};
    {
        const Changing changing(*this);
        const auto found = jobs_.find(id);
        if (found == jobs_.end() || !is_active(found->second.job.phase)) return false;
        Entry& entry = found->second;
        if (entry.cause == StopCause::none) entry.cause = cause;
        if (entry.cause == StopCause::cancel && entry.job.phase != LivePhase::canceling) {
            entry.job.phase = LivePhase::canceling;
            changed(entry, true);
        }
        stop = entry.stop;
    }
    stop.request_stop(); // runs callbacks: outside the lock
    return true;
}

void LiveJobs::stop_all(StopCause cause)
{
    std::vector<JobId> active;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [id, entry] : jobs_)
            if (is_active(entry.job.phase)) active.push_back(id);
    }
    for (const JobId& id : active)
        request_stop(id, cause);
}

StopCause LiveJobs::stop_cause(const JobId& id) const
{
    const std::lock_guard lock(mutex_);
    const auto found = jobs_.find(id);
    return found == jobs_.end() ? StopCause::none : found->second.cause;
}

LiveJobs::Settled LiveJobs::finish(const JobId& id, JobOutcome outcome, bool reused)
{
    const Changing changing(*this);
    Entry& entry = jobs_[id];
    if (entry.job.phase == LivePhase::canceling)
        outcome = JobOutcome{.phase = LivePhase::canceled, .finished_ms = outcome.finished_ms};
    entry.job.outcome = std::make_shared<const JobOutcome>(std::move(outcome));
    entry.job.phase = entry.job.outcome->phase;
    entry.job.joined = reused && entry.job.phase == LivePhase::succeeded;
    changed(entry, true);

    Settled settled{entry.job.outcome, {}};
    const auto same_key = by_key_.find(entry.sharing.render_key);
    if (same_key == by_key_.end()) return settled;
    for (const JobId& other : same_key->second) {
        Entry& follower = jobs_.at(other);
        if (follower.job.phase != LivePhase::queued || !serves(*settled.outcome, follower.sharing)) continue;
        follower.job.joined = true;
        follower.job.outcome = settled.outcome;
        follower.job.phase = LivePhase::succeeded;
        changed(follower, true);
        settled.followers.push_back(other);
    }
    return settled;
}

void LiveJobs::forget(const JobId& id)
{
    const Changing changing(*this);
    const auto found = jobs_.find(id);
    if (found != jobs_.end()) {
        const auto same_key = by_key_.find(found->second.sharing.render_key);
        if (same_key != by_key_.end()) {
            std::erase(same_key->second, id);
            if (same_key->second.empty()) by_key_.erase(same_key);
        }
        jobs_.erase(found);
    }
    queue_changes_ = ++changes_;
}

LiveJobs::Snapshot LiveJobs::snapshot(const JobId& id) const
{
    const std::lock_guard lock(mutex_);
    Snapshot snapshot{std::nullopt, {0, 0, queue_changes_}};
    const auto found = jobs_.find(id);
    if (found == jobs_.end()) return snapshot;
    snapshot.job = found->second.job;
    snapshot.mark.progress = found->second.progress_change;
    snapshot.mark.phase = found->second.phase_change;
    return snapshot;
}

std::unordered_map<JobId, LiveJob> LiveJobs::all() const
{
    const std::lock_guard lock(mutex_);
    std::unordered_map<JobId, LiveJob> jobs;
    for (const auto& [id, entry] : jobs_)
        jobs.emplace(id, entry.job);
    return jobs;
}

bool LiveJobs::wait(const JobId& id,
                    const Mark& mark,
                    std::chrono::steady_clock::time_point deadline,
                    Until until) const
{
    std::unique_lock lock(mutex_);
    bool moved = false;
    change_.wait_until(lock, deadline, [&] {
        const auto found = jobs_.find(id);
        // A job without an entry changes where some phase changes: it may be the one that is claimed next.
        if (found == jobs_.end())
            moved = mark.phase != 0 || queue_changes_ != mark.queue;
        else if (until == Until::end)
            moved = found->second.job.outcome != nullptr;
        else
            moved = found->second.phase_change != mark.phase ||
                    found->second.progress_change != mark.progress || queue_changes_ != mark.queue;
        return moved || closed_;
    });
    return moved && !closed_;
}

bool LiveJobs::wait_forgotten(const JobId& id, std::chrono::steady_clock::time_point deadline) const
{
    std::unique_lock lock(mutex_);
    return change_.wait_until(lock, deadline, [&] { return !jobs_.contains(id); });
}

void LiveJobs::close()
{
    const Changing changing(*this);
    closed_ = true;
}

std::vector<std::string> LiveJobs::image_digests() const
{
    const std::lock_guard lock(mutex_);
    std::vector<std::string> digests;
    for (const auto& [id, entry] : jobs_)
        if (entry.job.outcome && entry.job.outcome->phase == LivePhase::succeeded)
            digests.push_back(entry.job.outcome->result.image_digest);
    return digests;
}

} // namespace server
