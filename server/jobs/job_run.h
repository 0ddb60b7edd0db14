// run_job: one job from its request to its picture: import, plan, prepare, render, develop. Knows no queue.
//
// Threads  the caller's and the pool's.
// Errors   the client's faults are a value; StoreError, std::bad_alloc and whatever else the world does are
// thrown.
#pragma once

#include "api/job_request.h"
#include "renderer/description/limits.h"
#include "renderer/parallel/thread_pool.h"
#include "renderer/render.h"
#include "renderer/scene/scene_caches.h"
#include "server/import/import_service.h"
#include "server/jobs/live_jobs.h"

#include <functional>
#include <stop_token>
#include <string>
#include <variant>

namespace server {

struct JobRun {
    const JobId& id;
    const std::string& render_key;
    const api::JobRequest& request;
    std::stop_token stop;
    std::function<void()> running; // meshes and plan are done, rays begin
    renderer::ProgressSink progress;
};

struct RunTools {
    ImportService& imports;
    renderer::ThreadPool& pool;
    renderer::Limits limits;
    renderer::SceneCaches* caches = nullptr; // where nothing is rendered
};

struct StoppedRun {};

// The outcome but for its time; or why the job fails; or that `stop` was requested.
std::variant<JobOutcome, api::ProblemDetails, StoppedRun> run_job(const JobRun& run, const RunTools& tools);

// The plan alone, which needs the meshes imported: nothing is rendered.
std::variant<renderer::PlanReport, api::ProblemDetails, StoppedRun> plan_job(const JobRun& run,
                                                                             const RunTools& tools);

} // namespace server
