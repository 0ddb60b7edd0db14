// DocumentHandlers: what the service says of itself: discovery, health, version, capabilities, the contract.
#pragma once

#include "renderer/description/limits.h"
#include "server/http/router.h"
#include "server/jobs/job_service.h"
#include "server/store/store.h"

namespace server {

class DocumentHandlers {
public:
    DocumentHandlers(JobService& jobs, Store& store, const renderer::Limits& limits)
        : jobs_(jobs), store_(store), limits_(limits)
    {
    }

    void add_routes(Router& router);
    void add_health_routes(Router& router); // those of the second listener

private:
    void ready(Exchange& exchange);

    JobService& jobs_;
    Store& store_;
    const renderer::Limits& limits_;
};

} // namespace server
