// HttpServer: the HTTP face of the service: routes, negotiation, limits, and a health listener of its own.
//
// Handlers read, ask the job service, and reply; every answer has X-Request-Id. Errors of the world are
// caught once, around the handler: the log gets them in full, the client a public sentence and an id.
#pragma once

#include "renderer/description/limits.h"
#include "server/import/import_service.h"
#include "server/jobs/job_service.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace server {

struct HttpOptions {
    std::string host = "127.0.0.1";
    int port = 8080;     // 0: any free port
    int health_port = 0; // 0: any free port; the second listener, for /healthz and /readyz alone
    renderer::Limits limits;
    // Who reads an answer or sends a body more slowly than this is cut off.
    std::chrono::milliseconds write_stall{10000}; // silence
    std::uint64_t write_rate = 16 << 10;          // bytes a second on average, after the first 10 s
    // Requests that wait for a thread beyond this many are refused with 503.
    std::size_t connection_queue = 256;
    // Called once, when a listener broke and nobody can be reached any more; must not call stop().
    std::function<void()> on_deaf;
};

class HttpServer {
public:
    HttpServer(JobService& jobs,
               Store& store,
               BlobStore& blobs,
               ImportService& imports,
               const Log& log,
               HttpOptions options);
    ~HttpServer();
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    void start(); // binds and listens; std::system_error naming host and port if it cannot
    void stop();  // closes the listeners, answers what is under way, cuts off what takes over 6 s
    bool listening() const;
    int port() const; // the bound ones
    int health_port() const;
    std::vector<std::string> routes() const; // "GET /v1/jobs/{id}", ...: what openapi.json is held against

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace server
