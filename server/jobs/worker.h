// Worker: takes jobs from the store one after another, runs them, and hands their outcomes to the keeper.
//
// Owns the render pool. The catch site around a job is here: whatever is thrown ends that job, never the
// service.
// Threads  one of its own.
#pragma once

#include "api/job_request.h"
#include "renderer/description/limits.h"
#include "renderer/parallel/thread_pool.h"
#include "renderer/scene/scene_caches.h"
#include "server/import/import_service.h"
#include "server/jobs/live_jobs.h"
#include "server/jobs/result_keeper.h"
#include "server/jobs/wait_estimate.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>

namespace server {

class Worker {
public:
    struct Rooms {
        Store& store;
        BlobStore& blobs;
        ImportService& imports;
        LiveJobs& live;
        ResultKeeper& keeper;
        WaitEstimate& estimate;
        Log log;
        renderer::Limits limits;
    };
    Worker(const Rooms& rooms, unsigned threads) : rooms_(rooms), pool_(threads) {}
    ~Worker() { stop(); }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    void start();
    void stop(); // the job under way goes back to the queue

private:
    struct Task {
        Lease lease;
        JobRecord record;
        std::stop_token stop; // of this job
        std::int64_t started_ms = 0;
    };
    void run(const std::stop_token& stop);
    void take(const Lease& lease, const std::stop_token& stop);
    void work_on(const Task& task);
    void attempt(const Task& task);
    void run_request(const Task& task, const api::JobRequest& request);
    bool end_with_known_result(const Task& task, const Sharing& sharing);
    void end_rendered(const Task& task, JobOutcome outcome);
    void end_stopped(const Task& task, const api::JobRequest& request);
    void end(const Task& task, JobOutcome outcome);
    void end_failed(const Task& task, api::ProblemDetails error);
    void retry_later(const Task& task, const std::string& what);
    void give_back(const Task& task);
    void rest(const std::stop_token& stop);

    Rooms rooms_;
    renderer::ThreadPool pool_;
    renderer::SceneCaches caches_;
    unsigned failures_ = 0; // of the world, in a row
    std::mutex rest_mutex_;
    std::condition_variable_any rest_over_;
    std::jthread thread_;
};

} // namespace server
