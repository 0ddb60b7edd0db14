// HttpClient: requests to one service, patiently: what is busy or restarting is asked again.
//
// Retries  429, 503 and broken connections are tried again with growing pauses, not before Retry-After, for
//          as long as `patience_s`, and a last time when it ends. Every request here may be repeated: a POST of a job carries an
//          Idempotency-Key. A service that refuses the very first connection is not waited for: the URL is
//          more likely wrong.
// Threads  one at a time.
// Errors   UserError(unreachable) if patience ends, UserError(interrupted) once `stop` is requested.
#pragma once

#include "clients/cli/service_url.h"

#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace clients {

struct HttpRequest {
    std::string method = "GET";
    std::string path; // from the root: "/v1/jobs"
    std::vector<std::pair<std::string, std::string>> headers{};
    std::string body{};
    double wait_s = 0; // how long the service may take on purpose (Prefer: wait)
};

struct HttpAnswer {
    int status = 0;
    std::map<std::string, std::string> headers; // names in small letters
    std::string body;

    // Empty if there is none.
    std::string header(const std::string& name) const;
    // Retry-After in seconds, if it is there as a number.
    std::optional<double> retry_after_s() const;
};

class HttpClient {
public:
    HttpClient(ServiceUrl url, double patience_s, std::stop_token stop);
    ~HttpClient();
    HttpClient(const HttpClient&) = delete;
    HttpClient& operator=(const HttpClient&) = delete;

    HttpAnswer send(const HttpRequest& request);

    // Sleeps; throws UserError(interrupted) when stopped.
    void pause(double seconds);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace clients
