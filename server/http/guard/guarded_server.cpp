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
constexpr const char* kMethods = "GET, HEAD, POST, PUT, PATCH, DELETE, OPTIONS";

bool is_known_method(const std::string& method)
{
    static constexpr std::array<std::string_view, 7> known{
        "GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"};
    return std::find(known.begin(), known.end(), method) != known.end();
}

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
    set_post_routing_handler([](const httplib::Request& request, httplib::Response& response) {
        const std::string id = request.get_header_value(kRequestId);
        response.set_header(kRequestId, id.empty() ? make_job_id() : id);
        response.set_header("X-Content-Type-Options", "nosniff");
    });
}

void GuardedServer::start(const std::string& host, int port)
{
    listener_.emplace(host, port, log_);
    pool_.emplace(options_.threads, options_.queue);
    port_ = listener_->port();
    svr_sock_ = listener_->descriptor(); // without one httplib cuts its answers off
    listening_ = true;
    accepting_ = std::thread([this] { accept_all(); });
}

void GuardedServer::accept_all()
{
    for (int fd = listener_->accept(); fd >= 0; fd = listener_->accept()) {
        try {
            connections_.add(fd);
            if (!pool_->enqueue([this, fd] { handle_connection(fd); })) refuse_unread(fd);
        } catch (const std::exception& error) { // no memory for it: the next may find some
            connections_.close(fd);
            log_.write(LogLevel::error, "connection_failure", {{"what", error.what()}});
        }
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
    if (!pool_->finish_by(std::chrono::steady_clock::now() + options_.drain))
        log_.write(LogLevel::warning,
                   "connections_cut_off",
                   {{"count", static_cast<std::int64_t>(connections_.cut())}});
    pool_->shutdown();
    listener_.reset();
}

// Not a word is read, and nothing here may block: this is the accepting thread.
void GuardedServer::refuse_unread(int fd)
{
    static constexpr std::string_view answer =
        "HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nRetry-After: 1\r\n"
        "Content-Length: 0\r\n\r\n";
    if (send(fd, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0)
        log_.write(LogLevel::warning, "refusal_unsent");
    connections_.close(fd);
    log_.write(
        LogLevel::warning, "connection_refused", {{"reason", "every thread is taken and the queue is full"}});
}

void GuardedServer::handle_connection(int fd)
{
    try {
        ConnectionStream stream(fd, options_.stream);
        serve(stream);
    } catch (const std::exception& error) {
        log_.write(LogLevel::error, "connection_failure", {{"what", error.what()}});
    }
    connections_.close(fd);
}

void GuardedServer::serve(ConnectionStream& stream)
{
    for (std::size_t number = 1; number <= options_.requests_per_connection; ++number) {
        std::string block;
        const auto give_up = [&] { return stopping_ || (number > 1 && pool_->backlog()); };
        switch (stream.await_head(block, give_up)) {
        case ConnectionStream::Await::closed:
            return;
        case ConnectionStream::Await::too_slow:
            return refuse(stream, {}, {408, "request_timeout", "the header did not come in time"});
        case ConnectionStream::Await::too_large:
            return refuse(stream,
                          {},
                          {431,
                           "headers_too_large",
                           "the header may have " + std::to_string(kMaxHeadBytes) + " bytes"});
        case ConnectionStream::Await::ready:
            break;
        }
        const bool last = number == options_.requests_per_connection || give_up();
        if (!serve_one(stream, block, last)) return;
    }
}

bool GuardedServer::serve_one(ConnectionStream& stream, const std::string& block, bool last)
{
    const auto since = std::chrono::steady_clock::now();
    RequestHead head;
    if (const auto fault = read_head(block, head)) {
        refuse(stream, head, *fault);
        return false;
    }
    if (!is_known_method(head.method)) {
        refuse(stream, head, {405, "method_not_allowed", "methods: " + std::string(kMethods)});
        return false;
    }
    stream.begin(head);
    if (!place_body(stream, head)) {
        refuse(stream,
               head,
               {429,
                "too_many_bodies",
                "this client's address sends " + std::to_string(options_.bodies_per_client) +
                    " bodies already, which is all that one may: let some arrive first"});
        return false;
    }
    bool closed = false, served = false;
    try {
        served = process_request(
            stream, last, closed, [&](httplib::Request& request) { give_headers(head, stream, request); });
    } catch (const std::exception& error) { // the source of a body: its head has gone, so it is cut off
        log_.write(
            LogLevel::error, "answer_cut_off", {{"what", error.what()}, {"request_id", head.request_id}});
    }
    log_request(stream, head, served, since);
    if (!stream.body_complete() && !stream.write_failed()) stream.linger([this] { return pool_->backlog(); });
    return served && !closed && !stream.write_failed() && stream.body_complete();
}

// A small body that comes with its head, or close behind it, keeps nobody waiting.
bool GuardedServer::place_body(ConnectionStream& stream, const RequestHead& head)
{
    constexpr std::chrono::milliseconds kMoment{20};
    const bool announced = head.chunked || head.content_length.value_or(0) > 0;
    if (!announced || stream.body_comes_within(kMoment)) return true;
    std::string address;
    int port = 0;
    stream.get_remote_ip_and_port(address, port);
    auto place = bodies_.enter(address);
    if (!place) return false;
    stream.hold_until_body_is_read(std::move(*place));
    return true;
}

void GuardedServer::give_headers(const RequestHead& head,
                                 ConnectionStream& stream,
                                 httplib::Request& request) const
{
    for (const auto& [name, value] : head.fields)
        if (!is_kept_back(name))
            request.headers.emplace(strcasecmp(name.c_str(), "Content-Type") == 0 ? kBodyType : name, value);
    request.headers.emplace(kRequestId, head.request_id);
    request.progress = [this, &stream](std::uint64_t, std::uint64_t) {
        return !stopping_ && stream.peer_is_there();
    };
}

void GuardedServer::refuse(ConnectionStream& stream, const RequestHead& head, const HeadFault& fault) const
{
    const auto since = std::chrono::steady_clock::now();
    RequestHead shown = head;
    if (shown.request_id.empty()) shown.request_id = make_job_id();
    const std::string body = problem_text(fault.status, fault.code, fault.detail, shown.request_id);
    stream.begin({});
    const std::string answer =
        "HTTP/1.1 " + std::to_string(fault.status) + " Refused\r\nConnection: close\r\n" +
        (fault.status == 405 ? std::string("Allow: ") + kMethods + "\r\n" : std::string()) +
        (fault.status == 429 ? "Retry-After: 1\r\n" : "") + "Content-Type: " + kProblemType +
        "\r\nX-Content-Type-Options: nosniff\r\n" + kRequestId + ": " + shown.request_id +
        "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
    if (stream.write(answer.data(), answer.size()) > 0) stream.linger([this] { return pool_->backlog(); });
    log_request(stream, shown, true, since);
}

void GuardedServer::log_request(const ConnectionStream& stream,
                                const RequestHead& head,
                                bool served,
                                std::chrono::steady_clock::time_point since) const
{
    std::string address;
    int port = 0;
    stream.get_remote_ip_and_port(address, port);
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
    log_.write(LogLevel::info,
               "request",
               {{"method", head.method},
                {"path", std::string_view(head.target).substr(0, head.target.find('?'))},
                {"status", static_cast<std::int64_t>(stream.status())},
                {"ms", ms},
                {"bytes", static_cast<std::int64_t>(stream.bytes_written())},
                {"remote", address},
                {"complete", served && !stream.write_failed()},
                {"request_id", head.request_id}});
}

} // namespace server
