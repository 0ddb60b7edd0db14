// JobHandlers: /v1/jobs: submit, look, wait, list, cancel, forget; picture, layers, report and scene.
#pragma once

#include "renderer/description/limits.h"
#include "renderer/description/picture_formats.h"
#include "server/http/router.h"
#include "server/http/waiters.h"
#include "server/jobs/job_service.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <cstdint>
#include <optional>
#include <string>

namespace server {

class JobHandlers {
public:
    JobHandlers(
        JobService& jobs, Store& store, BlobStore& blobs, const renderer::Limits& limits, Waiters& waiters)
        : jobs_(jobs), store_(store), blobs_(blobs), limits_(limits), waiters_(waiters)
    {
    }

    void add_routes(Router& router);

private:
    void submit(Exchange& exchange);
    void plan(Exchange& exchange, const SubmitWords& words);
    void answer_submitted(Exchange& exchange, const SubmitAnswer& answer, bool waited);
    void list(Exchange& exchange);
    void get(Exchange& exchange);
    void cancel(Exchange& exchange);
    void remove(Exchange& exchange);
    void image(Exchange& exchange);
    void layer(Exchange& exchange);
    void report(Exchange& exchange);
    void scene(Exchange& exchange);

    // Waits while the client is there; with `known_etag` for a change, else for the end.
    std::optional<api::JobView>
    wait(Exchange& exchange, const std::string& id, std::uint64_t seconds, const std::string& known_etag);
    // The place, and how long; a place that cannot be had is answered with 429 and gives false.
    bool enter_wait(Exchange& exchange, std::optional<Waiters::Place>& place, std::uint64_t& seconds);
    // As long as the request prefers. With a place that is held where the answer is to be encoded then: that takes its
    // time, and this thread with it. False: answered, with 429.
    bool wait_for_picture(Exchange& exchange,
                          const std::string& id,
                          std::optional<Waiters::Place>& place,
                          bool to_encode);
    void reply_image(Exchange& exchange, const std::string& id, const renderer::PictureEncoding& encoding);
    // A picture or a layer of the job; `name`: of the file that a browser would save.
    void reply_encoded(Exchange& exchange,
                       const std::string& id,
                       const std::string& name,
                       const EncodedPicture& picture,
                       renderer::PictureFormat format);

    JobService& jobs_;
    Store& store_;
    BlobStore& blobs_;
    const renderer::Limits& limits_;
    Waiters& waiters_;
};

} // namespace server
