#include "server/http/http_server.h"

#include "server/http/asset_handlers.h"
#include "server/http/document_handlers.h"
#include "server/http/guard/guarded_server.h"
#include "server/http/job_handlers.h"
#include "server/http/router.h"

#include <algorithm>
#include <mutex>
#include <sys/resource.h>

namespace server {

namespace {

// Beside those that wait or stream, ordinary requests have these.
constexpr std::size_t kOrdinaryThreads = 16;
constexpr std::size_t kBodyThreads = 24;
constexpr std::size_t kHealthThreads = 2;
constexpr std::size_t kHealthQueue = 64;
constexpr std::size_t kHealthConnections = 256;
// Descriptors that are not connections': files, the importers' pipes, the store.
constexpr std::size_t kOtherDescriptors = 256;

// As many as there may be, and as there are descriptors for.
std::size_t most_connections()
{
    rlimit files{};
    if (getrlimit(RLIMIT_NOFILE, &files) != 0) return kHealthConnections;
    constexpr rlim_t kNotOurs = kOtherDescriptors + kHealthConnections;
    const rlim_t left = files.rlim_cur > 2 * kNotOurs ? files.rlim_cur - kNotOurs : files.rlim_cur / 2;
    return std::min(ParkingLimits().connections, static_cast<std::size_t>(left));
}

GuardOptions guard_options(const HttpOptions& options)
{
    GuardOptions guard;
    guard.threads = static_cast<std::size_t>(options.limits.waiters) + kOrdinaryThreads;
    guard.queue = options.connection_queue;
    guard.body_threads = kBodyThreads;
    guard.bodies_per_client = kBodyThreads / 3;
    guard.parking.connections = most_connections();
    guard.parking.per_client = std::max<std::size_t>(guard.parking.connections / 4, 1);
    guard.stream.head = std::chrono::seconds(options.limits.header_s);
    guard.stream.idle_body = std::chrono::seconds(options.limits.idle_body_s);
    guard.stream.idle_write = options.write_stall;
    guard.stream.min_rate = options.write_rate;
    return guard;
}

GuardOptions health_options(const HttpOptions& options)
{
    GuardOptions guard = guard_options(options);
    guard.threads = kHealthThreads;
    guard.body_threads = 1; // nothing here takes one
    guard.bodies_per_client = 1;
    guard.queue = kHealthQueue;
    guard.requests_per_connection = 1; // nobody keeps a place
    guard.parking = {kHealthConnections, kHealthConnections / 4, std::size_t{4} << 20};
    guard.drain = std::chrono::seconds(1);
    guard.stream.head = std::chrono::seconds(1);
    guard.stream.keep_alive = std::chrono::seconds(1);
    return guard;
}

Dispatch dispatch_to(const Router& router)
{
    return [&router](const httplib::Request& request,
                     httplib::Response& response,
                     const httplib::ContentReader* content) {
        Exchange exchange{request, response, content, {}};
        router.dispatch(exchange);
    };
}

} // namespace

struct HttpServer::State {
    State(JobService& job_service,
          Store& store,
          BlobStore& blobs,
          ImportService& imports,
          const Log& log,
          HttpOptions wanted)
        : options(std::move(wanted)), documents(job_service, store, options.limits),
          waiters(options.limits.waiters), assets(store, blobs, imports, options.limits, waiters),
          jobs(job_service, store, blobs, options.limits, waiters), router(log), health_router(log),
          main(telling(guard_options(options)), log, dispatch_to(router)),
          health(telling(health_options(options)), log, dispatch_to(health_router))
    {
        documents.add_routes(router);
        assets.add_routes(router);
        jobs.add_routes(router);
        documents.add_health_routes(health_router);
    }

    GuardOptions telling(GuardOptions guard)
    {
        if (options.on_deaf) guard.on_deaf = [this] { std::call_once(deaf, options.on_deaf); };
        return guard;
    }

    const HttpOptions options;
    std::once_flag deaf;
    DocumentHandlers documents;
    Waiters waiters; // of both that follow
    AssetHandlers assets;
    JobHandlers jobs;
    Router router, health_router;
    GuardedServer main, health;
};

HttpServer::HttpServer(JobService& jobs,
                       Store& store,
                       BlobStore& blobs,
                       ImportService& imports,
                       const Log& log,
                       HttpOptions options)
    : state_(std::make_unique<State>(jobs, store, blobs, imports, log, std::move(options)))
{
}

HttpServer::~HttpServer()
{
    stop();
}

void HttpServer::start()
{
    state_->main.start(state_->options.host, state_->options.port);
    state_->health.start(state_->options.host, state_->options.health_port);
}

void HttpServer::stop()
{
    state_->main.stop();
    state_->health.stop(); // last: it tells that the service drains
}

bool HttpServer::listening() const
{
    return state_->main.listening() && state_->health.listening();
}

int HttpServer::port() const
{
    return state_->main.port();
}
int HttpServer::health_port() const
{
    return state_->health.port();
}

std::vector<std::string> HttpServer::routes() const
{
    std::vector<std::string> all;
    for (const Route& route : state_->router.routes())
        all.push_back(route.method + " " + route.pattern);
    return all;
}

} // namespace server
