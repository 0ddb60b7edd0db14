// GuardedServer: httplib's server behind our guard: a listener, its threads, and for each connection the loop
// that reads a head, refuses what is doubtful, lets httplib have the rest, and logs a line a request.
//
// Every answer carries X-Request-Id; every error, also httplib's own, is application/problem+json.
// Of httplib only the reading of requests and the writing of answers is used: its accept loop closes the
// listener for good on errors that pass, and cuts off what is under way when it stops.
// Threads  start() and stop() from one; `dispatch` is called from many at once.
// Errors   start() throws std::system_error that names host and port. A listener that breaks later is logged
//          and told through `on_deaf`: nobody can be reached through it any more.
#pragma once

#include "server/http/guard/body_places.h"
#include "server/http/guard/connection_stream.h"
#include "server/http/guard/listener.h"
#include "server/http/guard/open_connections.h"
#include "server/http/guard/worker_pool.h"
#include "server/log/log.h"

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace server {

struct GuardOptions {
    std::size_t threads = 16;
    std::size_t queue = 256;           // connections that wait for a thread; beyond: 503 at once
    std::size_t bodies_per_client = 5; // connections of one that may be amid a body; beyond: 429 at once
    std::size_t requests_per_connection = 1000;
    std::chrono::milliseconds drain{5000}; // what is under way when the server stops has so long to end
    std::function<void()> on_deaf;         // called once, from a thread of the server; must not call stop()
    StreamLimits stream;
};

// What a handler finds among a request's headers beside those that the client sent. Content-Type is given as
// kBodyType, so that httplib leaves multipart and form bodies alone.
inline constexpr const char* kRequestId = "X-Request-Id";
inline constexpr const char* kBodyType = "Body-Type";

// `content` is null where the method has no body. request.progress(0, 0) is false as soon as waiting is of no
// more use: the client has gone, or the server stops. Must not throw.
using Dispatch =
    std::function<void(const httplib::Request&, httplib::Response&, const httplib::ContentReader* content)>;

class GuardedServer final : public httplib::Server {
public:
    GuardedServer(const GuardOptions& options, const Log& log, const Dispatch& dispatch);
    ~GuardedServer() override;

    void start(const std::string& host, int port);
    // Accepts nothing more, answers what is under way, and cuts off what is not done after `drain`. Handlers
    // must heed request.progress: one that does not is waited for.
    void stop();
    int port() const { return port_; }
    bool listening() const { return listening_; }

private:
    void accept_all();
    void handle_connection(int fd);
    void refuse_unread(int fd);
    void register_handlers(const Dispatch& dispatch);
    void serve(ConnectionStream& stream);
    bool serve_one(ConnectionStream& stream, const std::string& block, bool last);
    bool place_body(ConnectionStream& stream, const RequestHead& head);
    void refuse(ConnectionStream& stream, const RequestHead& head, const HeadFault& fault) const;
    void give_headers(const RequestHead& head, ConnectionStream& stream, httplib::Request& request) const;
    void log_request(const ConnectionStream& stream,
                     const RequestHead& head,
                     bool served,
                     std::chrono::steady_clock::time_point since) const;

    GuardOptions options_;
    const Log& log_;
    int port_ = 0;
    OpenConnections connections_;
    BodyPlaces bodies_;
    std::optional<Listener> listener_;
    std::optional<WorkerPool> pool_;
    std::atomic<bool> stopping_ = false, listening_ = false;
    std::thread accepting_;
};

} // namespace server
