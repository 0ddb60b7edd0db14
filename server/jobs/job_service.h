// JobService: a job's whole life between HTTP and renderer: submit, queue, prepare, render, keep, forget.
//
// Owns the worker thread and the render pool. Handlers call it and reply; they hold no state.
// Threads  every function may be called from any thread.
// Errors   the client's faults and "not there" are values; StoreError is the world's.
#pragma once

#include "api/job_request.h"
#include "api/job_view.h"
#include "api/problem.h"
#include "renderer/description/layers.h"
#include "renderer/description/limits.h"
#include "renderer/description/picture_formats.h"
#include "server/import/import_service.h"
#include "server/jobs/picture_cache.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

namespace server {

struct SubmitWords {
    std::string body;                                // the JSON as it came
    std::map<std::string, std::string> part_digests; // multipart: file part name -> digest, already stored
    std::string idempotency_key;
    bool no_cache = false; // Cache-Control: no-cache forces a new render
};

struct SubmitAnswer {
    api::JobView job;
    bool replayed = false; // Idempotency-Replayed: true
};

// What a list is asked for.
struct ListWords {
    std::optional<api::JobState> state{};
    std::optional<std::pair<std::string, std::string>> label{}; // name, value
    std::uint32_t limit = 50;
    std::string cursor{}; // empty: from the newest
};

struct JobServiceOptions {
    renderer::Limits limits;
    unsigned threads = 0; // of the render pool; 0: every core
    Log log{};
};

class JobService {
public:
    JobService(Store& store, BlobStore& blobs, ImportService& imports, const JobServiceOptions& options);
    ~JobService(); // stop() if it was not called
    JobService(const JobService&) = delete;
    JobService& operator=(const JobService&) = delete;

    void start(); // the worker
    // Graceful: refuses new jobs (503 draining), gives the running job back to the queue, joins the worker.
    void stop();
    bool draining() const;

    // 400, 413, 422, 429 queue_full, 503 draining or storage_full as ProblemDetails.
    std::variant<SubmitAnswer, api::ProblemDetails> submit(const SubmitWords& words);
    // What the job would need, as JSON text: nothing is stored or queued. Imports what it names, on the calling
    // thread, until `stop`.
    std::variant<std::string, api::ProblemDetails> plan(const SubmitWords& words,
                                                        const std::stop_token& stop);
    std::optional<api::JobView> get(const JobId& id);
    // Waits until the job is final or, with `known_etag`, until its view changes; at most `timeout`.
    std::optional<api::JobView>
    wait(const JobId& id, std::chrono::milliseconds timeout, const std::string& known_etag = {});
    std::variant<std::string, api::ProblemDetails> list(const ListWords& words); // JSON text
    std::optional<api::JobView> cancel(const JobId& id);                         // idempotent
    // Cancels if active, then forgets. Nothing; or why not: 404, 503 still_ending.
    std::optional<api::ProblemDetails> remove(const JobId& id);

    // The picture, or why not: 404, 504 still_running, 409 render_failed, 410 expired. A picture that the
    // disk lost makes the job queued again (504), or is named (500 result_damaged) if a mesh is gone too. 406
    // where the picture cannot be had in this encoding. What is not a PNG of 8 bits takes the time to encode it.
    std::variant<EncodedPicture, api::ProblemDetails> image(const JobId& id,
                                                            const renderer::PictureEncoding& encoding = {});
    // A layer beside it likewise; 404 also where the job was not asked for it. `encoding` is of a format that holds it.
    std::variant<EncodedPicture, api::ProblemDetails>
    layer(const JobId& id, renderer::Layer layer, const renderer::PictureEncoding& encoding);
    std::variant<std::string, api::ProblemDetails> report(const JobId& id); // JSON text, under this id
    std::variant<std::string, api::ProblemDetails>
    scene(const JobId& id); // as executed, or as accepted until then

    // Seconds until a full queue likely has a place: Retry-After of a 429.
    int estimated_wait_s() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// ETag of a job object: a digest of its JSON.
std::string etag_of(const api::JobView& view);

} // namespace server
