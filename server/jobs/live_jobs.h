// LiveJobs: what this process knows of its jobs before the store does: phase, progress, and outcomes not yet
// durable.
//
// An entry lives from submit (or claim) until the store knows the outcome. Whoever waits for a job waits
// here. A job that waits beside another with the same render key gets that one's result the moment it is
// there.
// Threads  every function may be called from any thread.
#pragma once

#include "api/problem.h"
#include "server/jobs/sharing.h"
#include "server/store/store.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <unordered_map>
#include <vector>

namespace server {

using PictureBytes = std::shared_ptr<const std::vector<std::byte>>;

enum class LivePhase : std::uint8_t { queued, preparing, running, canceling, succeeded, failed, canceled };

// How a job ended. Immutable once published.
struct JobOutcome {
    LivePhase phase = LivePhase::failed; // succeeded, failed or canceled
    JobResult result{};                  // when succeeded
    PictureBytes kept{}; // when succeeded, as in kept_picture.h; empty where it is already stored
    PictureBytes png{};  // beside `kept`, with the digest of its own
    std::string png_digest{};
    std::uint64_t non_finite_samples = 0;
    api::ProblemDetails error{}; // when failed
    std::int64_t finished_ms = 0;
};
using OutcomePtr = std::shared_ptr<const JobOutcome>;

enum class StopCause : std::uint8_t { none, cancel, drain, time_limit };

struct LiveJob {
    LivePhase phase = LivePhase::queued;
    double progress = 0;
    std::uint32_t samples = 0;
    bool joined = false; // shares the render of another job, or its result
    std::optional<std::int64_t> started_ms{};
    OutcomePtr outcome{};
};

class LiveJobs {
public:
    // A moment of a job, to wait for what changes after it.
    struct Mark {
        std::uint64_t progress = 0, phase = 0, queue = 0;
    };
    struct Snapshot {
        std::optional<LiveJob> job;
        Mark mark;
    };

    // A job on its way into the store. Its outcome at once, if another's result that is not yet stored serves
    // it.
    OutcomePtr add(const JobId& id, Sharing sharing);
    // The worker claimed it.
    struct Begun {
        std::stop_token stop;
        OutcomePtr outcome; // it has one already: there is nothing to do
    };
    Begun begin(const JobId& id, std::int64_t started_ms);
    // Once the worker has read the job; a job of an earlier process enters here, and may find as at add() that
    // another's result serves it. What was said at add() stands.
    struct Described {
        Sharing sharing;
        OutcomePtr outcome;
    };
    Described describe(const JobId& id, Sharing sharing);
    void set_running(const JobId& id);
    void set_progress(const JobId& id, double fraction, std::uint32_t samples);
    // Back in the queue: drained, or to be tried again.
    void requeue(const JobId& id);

    // True if the job is in the worker's hands: its render stops soon. The first cause stands.
    bool request_stop(const JobId& id, StopCause cause);
    void stop_all(StopCause cause);
    StopCause stop_cause(const JobId& id) const;

    struct Settled {
        OutcomePtr outcome;           // as published: canceled, where a cancel came first
        std::vector<JobId> followers; // queued jobs that ended with the same result
    };
    // `reused`: the outcome is another job's.
    Settled finish(const JobId& id, JobOutcome outcome, bool reused = false);
    void forget(const JobId& id); // the store knows the outcome

    Snapshot snapshot(const JobId& id) const;
    std::unordered_map<JobId, LiveJob> all() const;
    // Until the job ended, or, with Until::change, until anything that a client sees of it changed since `mark`:
    // phase, progress, place in the queue. A job not known here may have ended with every phase that changes.
    // False: time is up, or the service closes.
    enum class Until : std::uint8_t { end, change };
    bool wait(const JobId& id,
              const Mark& mark,
              std::chrono::steady_clock::time_point deadline,
              Until until) const;
    bool wait_forgotten(const JobId& id, std::chrono::steady_clock::time_point deadline) const;
    void close(); // every wait returns, now and later
    // Pictures that live outcomes name.
    std::vector<std::string> image_digests() const;

private:
    struct Entry {
        LiveJob job;
        Sharing sharing;
        std::stop_source stop{std::nostopstate};
        StopCause cause = StopCause::none;
        std::uint64_t progress_change = 0, phase_change = 0;
    };
    // The lock of whoever changes something. Waiters are called once it is free: called before, each would
    // wake only to wait for it.
    class Changing {
    public:
        explicit Changing(LiveJobs& jobs) : jobs_(jobs), lock_(jobs.mutex_) {}
        ~Changing()
        {
            lock_.unlock();
            jobs_.change_.notify_all();
        }
        Changing(const Changing&) = delete;
        Changing& operator=(const Changing&) = delete;

    private:
        LiveJobs& jobs_;
        std::unique_lock<std::mutex> lock_;
    };

    void changed(Entry& entry, bool phase);
    void index(const JobId& id, Entry& entry, Sharing sharing);
    bool is_under_way(const std::string& render_key) const;
    OutcomePtr published_result(const Sharing& sharing) const;

    mutable std::mutex mutex_;
    mutable std::condition_variable change_;
    std::unordered_map<JobId, Entry> jobs_;
    std::unordered_map<std::string, std::vector<JobId>> by_key_;
    std::uint64_t changes_ = 0;       // counts up; an entry remembers its last one
    std::uint64_t queue_changes_ = 0; // the last change of any job's phase
    bool closed_ = false;
};

} // namespace server
