#include "server/http/guard/guarded_server.h"

#include "api/problem.h"
#include "server/store/store.h"

#include <algorithm>
#include <array>
#include <exception>
#include <string_view>
#include <system_error>

namespace server {

namespace {

constexpr const char* kProblemType = "application/problem+json";
// Of an answer, before other connections have their turn on the thread.
constexpr std::size_t kBurst = 4 << 20;

// Fields that are the guard's own business, or that httplib would stumble over.
bool is_kept_back(const std::string& name)
{
    static constexpr std::array<const char*, 12> names{"Host",
                                                       "Content-Length",
                                                       "Transfer-Encoding",
                                                       "Connection",
                                                       "Expect",
                                                       "Accept-Encoding",
                                                       kRequestId,
                                                       kBodyType,
                                                       "REMOTE_ADDR",
                                                       "REMOTE_PORT",
                                                       "LOCAL_ADDR",
                                                       "LOCAL_PORT"};
    return std::any_of(
        names.begin(), names.end(), [&](const char* kept) { return strcasecmp(kept, name.c_str()) == 0; });
}

std::string
problem_text(int status, const std::string& code, const std::string& detail, const std::string& request_id)
{
    api::ProblemDetails problem;
    problem.status = status;
    problem.code = code;
    problem.detail = detail;
    problem.retryable = status == 503 || status == 429 || status == 408;
    problem.request_id = request_id;
    return api::write_problem(problem);
}

// An error that httplib made by itself, without a body.
void explain(const httplib::Request& request, httplib::Response& response)
{
    if (!response.body.empty()) return;
    const bool ours = response.status >= 500, nowhere = response.status == 404;
    response.set_content(problem_text(response.status,
                                      ours ? "internal" : (nowhere ? "not_found" : "bad_request"),
                                      ours      ? "the service failed; tell its keeper the request id"
                                      : nowhere ? "there is nothing here: GET / tells what is"
                                                : "the request could not be read as HTTP",
                                      request.get_header_value(kRequestId)),
                         kProblemType);
}

} // namespace

struct GuardedServer::StillWanted {
    const GuardedServer* server;
    ConnectionStream* stream;
    bool operator()(std::uint64_t, std::uint64_t) const
    {
        return !server->stopping_ && stream->peer_is_there();
    }
};

GuardedServer::GuardedServer(const GuardOptions& options, const Log& log, const Dispatch& dispatch)
    : options_(options), log_(log), bodies_(options.bodies_per_client)
{
    register_handlers(dispatch);
}

GuardedServer::~GuardedServer()
{
    stop();
}

void GuardedServer::register_handlers(const Dispatch& dispatch)
{
    const auto plain = [dispatch](const httplib::Request& request, httplib::Response& response) {
        dispatch(request, response, nullptr);
    };
    const auto with_body = [dispatch](const httplib::Request& request,
                                      httplib::Response& response,
                                      const httplib::ContentReader& content) {
        dispatch(request, response, &content);
    };
    // One pattern for all: paths are matched by our own table, never by std::regex, whose recursion is the
    // client's.
    Get(".*", plain);
    Options(".*", plain);
    Delete(".*", plain);
    Post(".*", HandlerWithContentReader(with_body));
    Put(".*", HandlerWithContentReader(with_body));
    Patch(".*", HandlerWithContentReader(with_body));
    set_error_handler(HandlerWithResponse([](const httplib::Request& request, httplib::Response& response) {
        explain(request, response);
        return HandlerResponse::Handled;
    }));
    // dispatch does not throw: this is for httplib itself, which would send what() as a header.
    set_exception_handler([this](const httplib::Request& request,
                                 httplib::Response& response,
                                 const std::exception_ptr& error) {
        response = {};
        response.version = "HTTP/1.1";
        response.status = 500;
        try {
            if (error) std::rethrow_exception(error);
        } catch (const std::exception& e) {
            const std::string id = request.get_header_value(kRequestId);
            log_.write(LogLevel::error, "http_failure", {{"what", e.what()}, {"request_id", id}});
        } catch (...) {
            log_.write(LogLevel::error, "http_failure");
        }
    });
    set_post_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
        const std::string id = request.get_header_value(kRequestId);
        response.set_header(kRequestId, id.empty() ? make_job_id() : id);
        response.set_header("X-Content-Type-Options", "nosniff");
        take_body_over(request, response);
    });
}

// httplib would hold its thread until the client has read all: it writes the head, and the rest is ours.
void GuardedServer::take_body_over(const httplib::Request& request, httplib::Response& response) const
{
    const auto* const wanted = request.progress.target<StillWanted>();
    if (!response.content_provider_ || wanted == nullptr) return;
    if (request.method != "HEAD")
        wanted->stream->give_body(std::move(response.content_provider_), response.content_length_);
    response.content_provider_ = nullptr;
}

void GuardedServer::start(const std::string& host, int port)
{
    listener_.emplace(host, port, log_);
    parked_.emplace(
        connections_,
        options_.parking,
        ParkedConnections::Callbacks{[this](Connection connection) { go_on(std::move(connection)); },
                                     [this](Connection connection, ParkedConnections::Why why) {
                                         guarded([&] { give_up(std::move(connection), why); });
                                     }});
    const auto work = [this](Connection connection) { guarded([&] { serve(std::move(connection)); }); };
    workers_.emplace(options_.threads, options_.queue, work);
    body_workers_.emplace(options_.body_threads, options_.queue, work);
    port_ = listener_->port();
    svr_sock_ = listener_->descriptor(); // without one httplib cuts its answers off
    listening_ = true;
    accepting_ = std::thread([this] { accept_all(); });
}

// What fails here concerns one connection, which closes.
template <typename Work>
void GuardedServer::guarded(Work&& work) const
{
    try {
        work();
    } catch (const std::exception& error) {
        log_.write(LogLevel::error, "connection_failure", {{"what", error.what()}});
    }
}

void GuardedServer::accept_all()
{
    for (int fd = listener_->accept(); fd >= 0; fd = listener_->accept()) {
        // No memory for it: the next may find some.
        guarded([&] {
            parked_->park(std::make_unique<ConnectionStream>(connections_.add(fd), options_.stream));
        });
    }
    listening_ = false;
    if (listener_->broken() == 0) return;
    log_.write(
        LogLevel::error,
        "listener_broken",
        {{"port", std::int64_t{port_}}, {"what", std::generic_category().message(listener_->broken())}});
    if (options_.on_deaf) options_.on_deaf();
}

void GuardedServer::stop()
{
    stopping_ = true;
    if (!accepting_.joinable()) return;
    listener_->stop();
    accepting_.join();
    parked_->drain();
    if (!connections_.wait_for_none(std::chrono::steady_clock::now() + options_.drain))
        log_.write(LogLevel::warning,
                   "connections_cut_off",
                   {{"count", static_cast<std::int64_t>(connections_.cut())}});
    parked_->stop();
    workers_->shutdown();
    body_workers_->shutdown();
    listener_.reset();
}

GuardedServer::Load GuardedServer::load() const
{
    return {connections_.count(),
            parked_->count(),
            workers_->queued() + body_workers_->queued(),
            workers_->threads(),
            body_workers_->threads()};
}

void GuardedServer::go_on(Connection connection)
{
    guarded([&] {
        if (connection->phase() == ConnectionStream::Phase::answer) {
            workers_->enqueue(connection, WorkerPool::What::goes_on);
        } else if (connection->intake().stage() == RequestIntake::Stage::faulty) {
            const HeadFault fault(connection->intake().fault());
            refuse(std::move(connection), fault);
        } else {
            hand_to_thread(std::move(connection));
        }
    });
}

void GuardedServer::hand_to_thread(Connection connection)
{
    static const HeadFault busy{503, "busy", "every thread is taken and the queue is full: ask again soon"};
    if (connection->intake().stage() == RequestIntake::Stage::ready) {
        if (!workers_->enqueue(connection)) refuse(std::move(connection), busy);
        return;
    }
    auto place = bodies_.enter(connection->client());
    if (!place)
        return refuse(std::move(connection),
                      {429,
                       "too_many_bodies",
                       "this client's address sends " + std::to_string(options_.bodies_per_client) +
                           " large bodies already, which is all that one may: let some arrive first"});
    connection->hold_until_body_is_read(std::move(*place));
    if (!body_workers_->enqueue(connection)) refuse(std::move(connection), busy);
}

void GuardedServer::give_up(Connection connection, ParkedConnections::Why why)
{
    using Stage = RequestIntake::Stage;
    if (connection->phase() == ConnectionStream::Phase::answer) return log_request(*connection, false);
    if (connection->phase() == ConnectionStream::Phase::farewell) return;
    const bool silent = connection->intake().stage() == Stage::nothing;
    if (why == ParkedConnections::Why::late) {
        if (silent) return;
        const bool in_head = connection->intake().stage() == Stage::head;
        return refuse(std::move(connection),
                      {408,
                       "request_timeout",
                       in_head ? "the header did not come in time" : "the body did not come in time"});
    }
    if (silent && connection->requests() > 1) return; // idle: its client expects to be closed one day
    // It has to go at once: whether the client hears why, it will see.
    connection->begin_answer();
    write_refusal(*connection, {503, "too_many_connections", "others need the place: ask again soon"});
    connection->send_answer(kBurst);
    log_request(*connection, false);
}

void GuardedServer::serve(Connection connection)
{
    if (connection->phase() == ConnectionStream::Phase::request) answer(*connection);
    send_rest(std::move(connection));
}

void GuardedServer::answer(ConnectionStream& stream)
{
    stream.begin_answer();
    const bool last = stopping_ || stream.requests() >= options_.requests_per_connection;
    bool closed = false;
    const bool served = process_request(
        stream, last, closed, [&](httplib::Request& request) { give_headers(stream, request); });
    if (last || closed || !served) stream.close_after_answer();
}

void GuardedServer::send_rest(Connection connection)
{
    AnswerOutbox::Sent sent = AnswerOutbox::Sent::failed;
    try {
        sent = connection->send_answer(kBurst);
    } catch (const std::exception& error) { // the source of a body: its head has gone, so it is cut off
        log_.write(LogLevel::error,
                   "answer_cut_off",
                   {{"what", error.what()}, {"request_id", connection->intake().head().request_id}});
    }
    switch (sent) {
    case AnswerOutbox::Sent::blocked:
        return parked_->park(std::move(connection));
    case AnswerOutbox::Sent::more:
        workers_->enqueue(connection, WorkerPool::What::goes_on);
        return;
    case AnswerOutbox::Sent::failed:
        return log_request(*connection, false);
    case AnswerOutbox::Sent::done:
        break;
    }
    log_request(*connection, true);
    if (!connection->closes_after_answer() && connection->body_complete())
        connection->next_request();
    else if (connection->needs_farewell())
        connection->begin_farewell();
    else
        return;
    parked_->park(std::move(connection));
}

void GuardedServer::refuse(Connection connection, const HeadFault& fault)
{
    connection->begin_answer();
    write_refusal(*connection, fault);
    send_rest(std::move(connection));
}

void GuardedServer::write_refusal(ConnectionStream& stream, const HeadFault& fault) const
{
    const std::string id = stream.request_id();
    const std::string body = problem_text(fault.status, fault.code, fault.detail, id);
    const std::string answer =
        "HTTP/1.1 " + std::to_string(fault.status) + " Refused\r\nConnection: close\r\n" +
        (fault.status == 405 ? std::string("Allow: ") + kKnownMethods + "\r\n" : std::string()) +
        (fault.status == 429 || fault.status == 503 ? "Retry-After: 1\r\n" : "") +
        "Content-Type: " + kProblemType + "\r\nX-Content-Type-Options: nosniff\r\n" + kRequestId + ": " + id +
        "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
    stream.write(answer.data(), answer.size());
    stream.close_after_answer();
}

void GuardedServer::give_headers(ConnectionStream& stream, httplib::Request& request) const
{
    const RequestHead& head = stream.intake().head();
    for (const auto& [name, value] : head.fields)
        if (!is_kept_back(name))
            request.headers.emplace(strcasecmp(name.c_str(), "Content-Type") == 0 ? kBodyType : name, value);
    request.headers.emplace(kRequestId, head.request_id);
    request.progress = StillWanted{this, &stream};
}

void GuardedServer::log_request(const ConnectionStream& stream, bool complete) const
{
    const RequestHead& head = stream.intake().head();
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - stream.begun()).count();
    log_.write(LogLevel::info,
               "request",
               {{"method", head.method},
                {"path", std::string_view(head.target).substr(0, head.target.find('?'))},
                {"status", static_cast<std::int64_t>(stream.status())},
                {"ms", ms},
                {"bytes", static_cast<std::int64_t>(stream.bytes_sent())},
                {"remote", stream.address()},
                {"complete", complete},
                {"request_id", head.request_id}});
}

} // namespace server
