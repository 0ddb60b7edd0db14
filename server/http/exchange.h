// Exchange: one request and the answer in the making, as a handler sees them.
#pragma once

#include "api/problem.h"
#include "renderer/description/limits.h"

#include <httplib.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace server {

struct Exchange {
    const httplib::Request& request;
    httplib::Response& response;
    const httplib::ContentReader* content;   // null where the method has no body
    std::map<std::string, std::string> path; // what stood for {id} and the like

    std::string header(const char* name) const; // repeated ones joined by ", "; empty: none
    bool has_header(const char* name) const { return request.has_header(name); }
    std::string request_id() const;
    std::optional<std::string> query(const char* name) const;
    // False as soon as waiting is of no more use: the client has gone, or the server stops.
    bool still_wanted() const { return !request.progress || request.progress(0, 0); }
};

// Bytes with a name of their own: a picture or an asset.
struct Payload {
    // The bytes from an offset on, as many as are at hand, but one at least; good until the next call. Throws
    // StoreError. Empty for HEAD.
    std::function<std::span<const std::byte>(std::uint64_t offset)> source{};
    std::function<void()>
        let_go{}; // of what the source can have again: the client makes us wait. May be empty
    std::uint64_t size = 0;
    std::string digest; // "sha256:<hex>"
    std::string content_type;
};

void reply_json(Exchange& exchange, int status, const std::string& json);
// With the request id filled in, and Retry-After where trying again may help.
void reply_problem(Exchange& exchange, api::ProblemDetails problem, int retry_after_s = 1);
// 200, 206, 304 or 416, with ETag, Repr-Digest and Accept-Ranges: If-None-Match, Range and If-Range are
// honoured. A source that throws at the first byte makes this throw; later, it cuts the answer off.
void reply_payload(Exchange& exchange, const Payload& payload);
// 304 if the client knows this state already, else 200 with the JSON; `etag` comes without quotes.
void reply_json_with_etag(Exchange& exchange, const std::string& json, const std::string& etag);

api::ProblemDetails problem(int status, std::string code, std::string detail);
// 429: every place for requests that wait is taken.
api::ProblemDetails too_many_waiters(const renderer::Limits& limits);
// 422 invalid_query.
api::ProblemDetails query_problem(std::string code, std::string detail);

// `header` is an If-None-Match: a list of quoted tags, weak or not, or *.
bool names_etag(const std::string& header, const std::string& etag);
// "sha256:<hex>" as the value of Repr-Digest: sha-256=:<base64>:
std::string repr_digest(const std::string& digest);

} // namespace server
