#include "clients/cli/http_client.h"

#include "clients/cli/user_error.h"

#include <httplib.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace clients {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFirstPauseS = 0.25, kLongestPauseS = 8;
constexpr double kConnectS = 10, kWriteS = 60, kReadS = 60;

struct Attempt {
    std::optional<HttpAnswer> answer;
    std::string failure;  // why there is none
    bool refused = false; // no connection was made at all
};

std::string lower(std::string text)
{
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

bool is_busy(int status)
{
    return status == 429 || status == 503;
}

} // namespace

std::string HttpAnswer::header(const std::string& name) const
{
    const auto found = headers.find(name);
    return found == headers.end() ? std::string() : found->second;
}

std::optional<double> HttpAnswer::retry_after_s() const
{
    const std::string text = header("retry-after");
    unsigned seconds = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return seconds;
}

struct HttpClient::State {
    ServiceUrl url;
    double patience_s;
    std::stop_token stop;
    httplib::Client client;
    bool answered = false; // ever

    State(ServiceUrl service, double patience, std::stop_token token)
        : url(std::move(service)), patience_s(patience), stop(std::move(token)), client(url.origin)
    {
        if (!client.is_valid())
            throw UserError(ExitCode::usage, url.origin + " cannot be used as the service's URL");
        client.set_keep_alive(true);
        client.set_tcp_nodelay(true);
        client.set_connection_timeout(std::chrono::duration<double>(kConnectS));
        client.set_write_timeout(std::chrono::duration<double>(kWriteS));
    }

    Attempt attempt(const HttpRequest& words)
    {
        httplib::Request request;
        request.method = words.method;
        request.path = url.prefix + words.path;
        for (const auto& [name, value] : words.headers)
            request.headers.emplace(name, value);
        request.body = words.body;
        client.set_read_timeout(std::chrono::duration<double>(kReadS + words.wait_s));
        const std::stop_callback hang_up(stop, [this] { client.stop(); });
        const httplib::Result result = client.send(request);
        if (!result) {
            const bool refused = result.error() == httplib::Error::Connection ||
                                 result.error() == httplib::Error::ConnectionTimeout;
            return {std::nullopt, httplib::to_string(result.error()), refused};
        }
        answered = true;
        HttpAnswer answer{.status = result->status, .headers = {}, .body = result->body};
        for (const auto& [name, value] : result->headers)
            answer.headers.emplace(lower(name), value);
        return {std::move(answer), {}, false};
    }
};

HttpClient::HttpClient(ServiceUrl url, double patience_s, std::stop_token stop)
    : state_(std::make_unique<State>(std::move(url), patience_s, std::move(stop)))
{
}

HttpClient::~HttpClient() = default;

HttpAnswer HttpClient::send(const HttpRequest& request)
{
    const Clock::time_point deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                          std::chrono::duration<double>(state_->patience_s));
    for (double pause_s = kFirstPauseS;; pause_s = std::min(2 * pause_s, kLongestPauseS)) {
        const bool first_contact = !state_->answered;
        Attempt attempt = state_->attempt(request);
        if (state_->stop.stop_requested()) throw UserError(ExitCode::interrupted, "interrupted");
        if (attempt.answer && !is_busy(attempt.answer->status)) return *std::move(attempt.answer);
        if (!attempt.answer && attempt.refused && first_contact)
            throw UserError(ExitCode::unreachable,
                            "no service at " + state_->url.origin + " (" + attempt.failure +
                                "): start heliographd, or give --url or HELIOGRAPH_URL");
        const double left_s = std::chrono::duration<double>(deadline - Clock::now()).count();
        if (left_s <= 0) {
            if (attempt.answer) return *std::move(attempt.answer);
            throw UserError(ExitCode::unreachable,
                            state_->url.origin + " does not answer (" + attempt.failure + ')');
        }
        const double asked_s = attempt.answer ? attempt.answer->retry_after_s().value_or(0) : 0;
        pause(std::min(std::max(pause_s, asked_s), left_s)); // Retry-After is a guess: it may be free before
    }
}

void HttpClient::pause(double seconds)
{
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_for(lock, state_->stop, std::chrono::duration<double>(seconds), [] { return false; });
    if (state_->stop.stop_requested()) throw UserError(ExitCode::interrupted, "interrupted");
}

} // namespace clients
