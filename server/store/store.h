// Store: where jobs live. A durable, fenced queue: SqliteStore for a node, MemStore for tests; one
// conformance suite.
//
// Durability  submit(), cancel(), remove(), sweep(), expire_results() and forget_ended() outlast a power cut when
//             they return. What workers do (claim, complete, release, fail, confirm_cancel, render_again)
//             outlasts the death of the process, and a power cut a little later: a lost result renders again to
//             the same bytes. Everyone reads what was written.
// Fencing     claim() raises a job's epoch; complete(), fail(), release() and renew() with an older epoch do
//             nothing and say so. A lease that ran out is still its owner's until another claim takes the
//             job.
// Attempts    claim() counts one, release() takes it back, a restart or a lease that ran out does not. fail()
//             with `retry` gives up after kMaxAttempts. A job that kills its worker never gets there: who
//             claims a job with more than kMaxAttempts attempts must fail it without starting (the job
//             service does).
// Cancel      once cancel_requested, a job ends as canceled by whatever comes first: confirm_cancel(),
//             release(), a restart, a lease that ran out, fail() with `retry`, even complete(), whose result
//             is not kept.
// Threads     every function may be called from any thread.
// Texts       requests, reports, scenes and errors are kept once, however many jobs have the same; only whom it
//             concerns reads them.
// Errors      the world's failures (disk full, corrupt file) throw StoreError; everything else is a value.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace server {

// A job that was tried this often is not tried again.
inline constexpr std::uint32_t kMaxAttempts = 5;

struct StoreError : std::runtime_error {
    bool storage_full = false;
    StoreError(const std::string& what, bool full) : std::runtime_error(what), storage_full(full) {}
};

using JobId = std::string;  // 128 random bits, 32 hex digits
using Tenant = std::string; // "" until keys exist

// Stored states, as numbers on disk; `preparing`, `running` and `canceling` are told apart by the job service, in memory.
enum class StoredState : std::uint8_t { queued, leased, succeeded, failed, canceled, expired };

// Everything a job is, as the client gave it. Opaque text to the store.
struct JobSpec {
    std::string request_json;               // api::write_job of the accepted request
    std::string render_key;                 // "sha256:..."
    std::vector<std::string> asset_digests; // in use while the job is not final
    int priority = 50;
    std::map<std::string, std::string> labels;
    bool no_cache = false;    // takes no other job's result, at no time
    std::uint32_t layers = 0; // bits of those that are kept beside its picture
};

struct JobResult {
    std::string image_digest; // of the blob that keeps the picture, "sha256:..."
    std::string report_json;
    std::string scene_json;    // the scene as executed
    std::uint32_t samples = 0; // in every pixel
    bool reusable = true;      // false: stopped by time, so another job with this render_key renders anew
    friend bool operator==(const JobResult&, const JobResult&) = default;
};

// Why a job failed: api::write_problem, without the list of faults and with it.
struct JobFailure {
    std::string summary_json;
    std::string whole_json;
    friend bool operator==(const JobFailure&, const JobFailure&) = default;
};

struct JobRecord {
    JobId id;
    Tenant tenant;
    JobSpec spec;
    StoredState state = StoredState::queued;
    std::uint64_t epoch = 0;
    std::uint32_t attempts = 0;
    bool cancel_requested = false;
    bool reused = false; // born succeeded from another job's result
    std::int64_t created_ms = 0;
    std::optional<std::int64_t> started_ms; // of the present or last attempt; none while queued
    std::optional<std::int64_t> finished_ms;
    std::optional<JobResult> result;
    JobFailure failure; // when failed
};

// A run of work units of one pass of a job. One node renders whole jobs: pass 0, first 0, count 0 means all.
struct Lease {
    JobId job;
    std::uint32_t pass = 0, first = 0, count = 0;
    std::uint64_t epoch = 0;
};

// `idempotency_key` empty: none. `body_digest`: of the request as sent, to tell a replay from a reuse of the
// key.
struct SubmitRequest {
    JobId id; // from make_job_id(), so that the caller knows it first; empty: the store makes one
    Tenant tenant;
    std::string idempotency_key;
    std::string body_digest;
    JobSpec spec;
    bool allow_reuse = true;       // of a succeeded job with the same render_key
    std::uint64_t queue_limit = 0; // refuse when this many wait already; 0: no limit
    std::int64_t now_ms = 0;
};

enum class SubmitStatus : std::uint8_t { accepted, replayed, key_reused, queue_full };

struct Submitted {
    SubmitStatus status = SubmitStatus::accepted;
    JobRecord job; // the new or the replayed one, as find() gives it at least; unset for the other two
};

struct ListQuery {
    Tenant tenant;
    std::optional<StoredState> state{};
    std::vector<JobId> also{}; // beside those of the state, whatever theirs is; the rest holds for them too
    std::optional<std::pair<std::string, std::string>> label{}; // name, value
    std::uint32_t limit = 50;
    std::string cursor{}; // empty: from the newest
};

struct ListPage {
    std::vector<JobRecord> jobs; // newest first
    std::string next_cursor;     // empty: no more; it stays good while jobs come and go
    bool bad_cursor = false;     // the query's cursor is none of ours
};

struct QueueDepth {
    std::uint64_t queued = 0, leased = 0;
};

// Leases run by a clock that never jumps; the wall clock only stamps started_ms and ages idempotency keys.
struct StoreClock {
    std::function<std::chrono::steady_clock::time_point()> steady = std::chrono::steady_clock::now;
    std::function<std::int64_t()> wall_ms = [] {
        const auto now = std::chrono::system_clock::now().time_since_epoch();
        return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
    };
};

class Store {
public:
    virtual ~Store() = default;

    virtual Submitted submit(const SubmitRequest& request) = 0;
    virtual std::optional<JobRecord> get(const Tenant& tenant, const JobId& id) = 0;
    // Without request_json, report_json, scene_json and asset_digests, which are empty: what a status shows.
    virtual std::optional<JobRecord> find(const Tenant& tenant, const JobId& id) = 0;
    // As find() gives them, and without failure.whole_json.
    virtual ListPage list(const ListQuery& query) = 0;
    virtual QueueDepth depth() = 0;
    // True from a write that found the disk full until one works again. As long as it is so, asking tries a
    // write of its own: a service that is sent nothing because it is full would never learn that it is not.
    virtual bool storage_full() = 0;
    // How many queued jobs would be claimed before this one; nothing if it is not queued.
    virtual std::optional<std::uint32_t> queue_position(const JobId& id) = 0;

    // Highest priority first, then oldest. At most `max`; empty when nothing waits.
    virtual std::vector<Lease>
    claim(const std::string& worker, std::size_t max, std::chrono::milliseconds ttl) = 0;
    virtual std::size_t renew(const std::vector<Lease>& leases,
                              std::chrono::milliseconds ttl) = 0; // still owned
    // `reused`: the result is another job's. False: fenced, or canceled meanwhile; the result is not kept.
    virtual bool
    complete(const Lease& lease, const JobResult& result, std::int64_t now_ms, bool reused = false) = 0;
    // A queued job takes the result of another with the same render_key: succeeded and `reused`, without
    // being claimed. False if it is not queued.
    virtual bool complete_queued(const JobId& id, const JobResult& result, std::int64_t now_ms) = 0;
    // The result that a succeeded job with this render_key has, the newest such job's; what submit() would
    // reuse. Its picture alone; the whole.
    virtual std::optional<std::string> find_picture(const Tenant& tenant, const std::string& render_key) = 0;
    virtual std::optional<JobResult> find_result(const Tenant& tenant, const std::string& render_key) = 0;
    virtual void
    release(const std::vector<Lease>& leases) = 0; // drain: claimable at once, attempt not counted
    // retry: back to the queue unless it was tried 5 times; else failed. False: fenced.
    virtual bool fail(const Lease& lease, const JobFailure& why, bool retry, std::int64_t now_ms) = 0;
    // The worker's answer to cancel_requested: the job is canceled. False: fenced.
    virtual bool confirm_cancel(const Lease& lease, std::int64_t now_ms) = 0;

    // Queued: canceled at once. Leased: cancel_requested. Final: nothing changes. Nothing if there is no such
    // job.
    virtual std::optional<JobRecord> cancel(const Tenant& tenant, const JobId& id, std::int64_t now_ms) = 0;
    // A succeeded job whose picture was lost waits again, as if it had never been tried; its result is
    // dropped. False: it is not succeeded with this picture.
    virtual bool render_again(const Tenant& tenant, const JobId& id, const std::string& image_digest) = 0;
    // Forgets a final job; false if there is none or it is not final.
    virtual bool remove(const Tenant& tenant, const JobId& id) = 0;

    // Jobs that were final before `before_ms` become expired (result dropped), those that were so a week
    // before it are forgotten, and idempotency keys older than 24 h. The number of jobs expired or forgotten.
    virtual std::size_t sweep(std::int64_t before_ms) = 0;
    // A moment in the order of submission.
    virtual std::uint64_t newest() = 0;
    // Jobs that succeeded with one of these pictures become expired, unless one of them was submitted after
    // `newest`: then all of that picture stay. The pictures whose jobs expired, or that no job had.
    virtual std::vector<std::string> expire_results(const std::vector<std::string>& image_digests,
                                                    std::uint64_t newest) = 0;
    // Forgets final jobs that have no result, those that ended first, at most so many. How many.
    virtual std::size_t forget_ended(std::size_t most) = 0;
    // What the jobs take on disk, free space within files not counted.
    virtual std::uint64_t stored_bytes() = 0;
    // Assets that a job not final still needs.
    virtual std::vector<std::string> assets_in_use() = 0;
    // Pictures of kept results.
    virtual std::vector<std::string> pictures() = 0;
    virtual bool shows(const std::string& image_digest) = 0; // whether it is one of them
    // Returns at the latest after `timeout`, or as soon as something may be claimed
    // or `stop` is requested.
    virtual void wait_work(std::chrono::milliseconds timeout, std::stop_token stop) = 0;
};

// 128 bits from getrandom as 32 hex digits.
JobId make_job_id();

} // namespace server
