// ResultKeeper: makes outcomes durable behind the clients' backs, and lets old ones go.
//
// A finished picture is served from memory at once; this thread writes it, then its row. If the disk refuses,
// it tries again until it works or the service stops (then the job is released, and renders again to the same
// bytes). The results least recently used go first where all jobs together are over their limit; a picture
// goes with everything of the jobs that show it, and takes them to `expired`. Where the rows of the jobs alone
// are over half of it, those that have no result are forgotten before that.
// Threads  one of its own; every function may be called from any thread.
// Errors   logged here, never thrown, but by collect().
#pragma once

#include "server/jobs/live_jobs.h"
#include "server/jobs/picture_cache.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

namespace server {

struct KeptOutcome {
    std::vector<JobId> queued;  // jobs not claimed that take this outcome
    std::optional<Lease> lease; // of the job that was claimed for it
    OutcomePtr outcome;
    bool reused = false; // another job's render made it
};

// What it will take on disk, but for what others have of it.
std::uint64_t stored_bytes_of(const JobOutcome& outcome);

class ResultKeeper {
public:
    struct Rooms {
        Store& store;
        BlobStore& blobs;
        LiveJobs& live;
        PictureCache& pictures;
        Log log;
        std::chrono::seconds retention;
        std::uint64_t most_bytes; // of pictures and rows; what is finished last stays whatever it takes
    };
    explicit ResultKeeper(const Rooms& rooms) : rooms_(rooms) {}
    ~ResultKeeper() { stop(); }
    ResultKeeper(const ResultKeeper&) = delete;
    ResultKeeper& operator=(const ResultKeeper&) = delete;

    void start();
    void stop_waiting(); // keep() does not wait any more: the service stops
    void stop();         // writes what it has; what cannot be written is released
    // Takes it over. With a lease, waits while several others are not yet written: the disk's speed bounds
    // memory.
    void keep(KeptOutcome kept);
    // Lets results go until `bytes` more fit. False: they do not, what is here is not finished.
    bool make_room(std::uint64_t bytes);
    // While this is held, no stored picture is removed.
    std::unique_lock<std::mutex> hold_results() { return std::unique_lock(results_); }
    // Removes the picture if no job needs it any more.
    void collect(const std::string& image_digest);

private:
    void run(const std::stop_token& stop);
    bool has_room_for(const JobOutcome& outcome) const; // mutex_ is held
    bool try_keep(const KeptOutcome& kept);
    void store_outcome(const KeptOutcome& kept);
    void store_lease(const KeptOutcome& kept, const Lease& lease);
    void forget_if_final(const JobId& id);
    void give_back(const KeptOutcome& kept);
    void sweep();
    void collect_all();
    bool is_needed(const std::string& digest);
    std::uint64_t used_bytes();
    bool fits(std::uint64_t bytes);
    bool free_room(std::uint64_t bytes); // results_ is held
    bool expire_pictures(std::uint64_t bytes);

    Rooms rooms_;
    std::mutex results_; // held while pictures are written or removed
    std::mutex mutex_;
    std::condition_variable_any change_;
    bool closing_ = false;
    std::deque<KeptOutcome> waiting_; // the first one is being written
    std::jthread thread_;
};

} // namespace server
