// GuardedServer: httplib's server behind our guard: a listener, connections that wait without threads, threads
// that serve what has come, and a log line a request.
//
// Every answer carries X-Request-Id; every error, also httplib's own, is application/problem+json.
// Of httplib only the reading of requests and the writing of answers is used: its accept loop closes the
// listener for good on errors that pass, and cuts off what is under way when it stops.
// Walk     accepted, parked until a request is whole, served by a worker, parked while its answer is not read
//          as fast as it goes, parked for the next request. A large body is read by a pool of its own.
// Threads  start() and stop() from one; `dispatch` is called from many at once.
// Errors   start() throws std::system_error that names host and port. A listener that breaks later is logged
//          and told through `on_deaf`: nobody can be reached through it any more.
#pragma once

#include "server/http/guard/body_places.h"
#include "server/http/guard/connection_stream.h"
#include "server/http/guard/listener.h"
#include "server/http/guard/open_connections.h"
#include "server/http/guard/parked_connections.h"
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
    std::size_t threads = 16;          // for requests that are whole
    std::size_t body_threads = 24;     // for those whose large bodies are on their way
    std::size_t bodies_per_client = 8; // of one client, at work or queued; beyond: 429 at once
    std::size_t queue = 256;           // requests that wait for a thread, in each pool; beyond: 503 at once
    std::size_t requests_per_connection = 1000;
    std::chrono::milliseconds drain{5000}; // what is under way when the server stops has so long to end
    std::function<void()> on_deaf;         // called once, from a thread of the server; must not call stop()
    ParkingLimits parking;
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

    // What it has under way; a connection is in one place at a time.
    struct Load {
        std::size_t connections, parked, queued;
        std::size_t threads, body_threads; // made so far
    };
    Load load() const;

private:
    struct StillWanted; // what a request's progress() is
    void accept_all();
    void register_handlers(const Dispatch& dispatch);
    void go_on(Connection connection);
    void give_up(Connection connection, ParkedConnections::Why why);
    void hand_to_thread(Connection connection);
    void serve(Connection connection);
    void answer(ConnectionStream& stream);
    void take_body_over(const httplib::Request& request, httplib::Response& response) const;
    void send_rest(Connection connection);
    void refuse(Connection connection, const HeadFault& fault);
    void write_refusal(ConnectionStream& stream, const HeadFault& fault) const;
    void give_headers(ConnectionStream& stream, httplib::Request& request) const;
    void log_request(const ConnectionStream& stream, bool complete) const;
    template <typename Work>
    void guarded(Work&& work) const;

    GuardOptions options_;
    const Log& log_;
    int port_ = 0;
    OpenConnections connections_;
    BodyPlaces bodies_;
    std::optional<Listener> listener_;
    std::optional<ParkedConnections> parked_; // before the pools, whose threads park
    std::optional<WorkerPool> workers_, body_workers_;
    std::atomic<bool> stopping_ = false, listening_ = false;
    std::thread accepting_;
};

} // namespace server
