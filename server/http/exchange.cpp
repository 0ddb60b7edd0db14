#include "server/http/exchange.h"

#include "api/words/limit_words.h"
#include "server/http/byte_range.h"
#include "server/http/guard/guarded_server.h"

#include <algorithm>

namespace server {

namespace {

constexpr const char* kJson = "application/json";
constexpr const char* kProblem = "application/problem+json";

std::string in_quotes(const std::string& etag)
{
    return '"' + etag + '"';
}

// The answer's bytes from `first`, straight from their source: nothing large is copied or held.
void give_bytes(httplib::Response& response, const Payload& payload, std::uint64_t first, std::uint64_t count)
{
    if (count == 0) return response.set_content("", payload.content_type);
    if (payload.source) payload.source(first); // what is damaged here can still be said with a status
    response.set_content_provider(static_cast<std::size_t>(count),
                                  payload.content_type,
                                  [source = payload.source, let_go = payload.let_go, first](
                                      std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                      if (!source) return false;
                                      if (length == 0) { // as AnswerOutbox asks
                                          if (let_go) let_go();
                                          return true;
                                      }
                                      const std::span<const std::byte> bytes = source(first + offset);
                                      return sink.write(reinterpret_cast<const char*>(bytes.data()),
                                                        std::min(length, bytes.size()));
                                  });
}

unsigned hex_value(char c)
{
    return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
}

} // namespace

std::string Exchange::header(const char* name) const
{
    std::string joined;
    const auto [begin, end] = request.headers.equal_range(name);
    for (auto field = begin; field != end; ++field)
        joined += (field == begin ? "" : ", ") + field->second;
    return joined;
}

std::string Exchange::request_id() const
{
    return request.get_header_value(kRequestId);
}

std::optional<std::string> Exchange::query(const char* name) const
{
    const auto found = request.params.find(name);
    if (found == request.params.end()) return std::nullopt;
    return found->second;
}

void reply_json(Exchange& exchange, int status, const std::string& json)
{
    exchange.response.status = status;
    exchange.response.set_content(json, kJson);
}

void reply_problem(Exchange& exchange, api::ProblemDetails problem, int retry_after_s)
{
    problem.request_id = exchange.request_id();
    exchange.response.status = problem.status;
    if (problem.retryable || problem.status == 429 || problem.status == 503 || problem.status == 504)
        exchange.response.set_header("Retry-After", std::to_string(std::max(retry_after_s, 1)));
    exchange.response.set_content(api::write_problem(problem), kProblem);
}

void reply_payload(Exchange& exchange, const Payload& payload)
{
    httplib::Response& response = exchange.response;
    response.set_header("ETag", in_quotes(payload.digest));
    response.set_header("Repr-Digest", repr_digest(payload.digest));
    response.set_header("Accept-Ranges", "bytes");
    if (names_etag(exchange.header("If-None-Match"), payload.digest)) {
        response.status = 304;
        return;
    }
    // If-Range names the state that the range is of; of another state the whole is sent (RFC 9110, 13.1.5).
    const bool same_state =
        !exchange.has_header("If-Range") || exchange.header("If-Range") == in_quotes(payload.digest);
    const auto range = same_state ? read_byte_range(exchange.header("Range"), payload.size) : ByteRange{};
    switch (range.kind) {
    case ByteRange::Kind::whole:
        response.status = 200;
        return give_bytes(response, payload, 0, payload.size);
    case ByteRange::Kind::part:
        response.status = 206;
        response.set_header("Content-Range",
                            "bytes " + std::to_string(range.first) + "-" +
                                std::to_string(range.first + range.count - 1) + "/" +
                                std::to_string(payload.size));
        return give_bytes(response, payload, range.first, range.count);
    case ByteRange::Kind::beyond:
        response.set_header("Content-Range", "bytes */" + std::to_string(payload.size));
        return reply_problem(exchange,
                             problem(416,
                                     "range_not_satisfiable",
                                     "the range lies beyond the " + std::to_string(payload.size) + " bytes"));
    }
}

void reply_json_with_etag(Exchange& exchange, const std::string& json, const std::string& etag)
{
    exchange.response.set_header("ETag", in_quotes(etag));
    if (names_etag(exchange.header("If-None-Match"), etag))
        exchange.response.status = 304;
    else
        reply_json(exchange, 200, json);
}

api::ProblemDetails problem(int status, std::string code, std::string detail)
{
    api::ProblemDetails details;
    details.status = status;
    details.code = std::move(code);
    details.detail = std::move(detail);
    details.retryable = status == 429 || status == 503 || status == 504;
    return details;
}

api::ProblemDetails too_many_waiters(const renderer::Limits& limits)
{
    return problem(
        429,
        "too_many_waiters",
        std::to_string(limits.waiters) +
            " requests wait already, the limit waiters; ask later or, for a job, without Prefer: wait; "
            "the service's flag " +
            api::flag_of("waiters") + " raises it");
}

api::ProblemDetails query_problem(std::string code, std::string detail)
{
    return api::problem_from_faults(422, "invalid_query", {{"", std::move(code), std::move(detail)}});
}

bool names_etag(const std::string& header, const std::string& etag)
{
    if (header == "*") return true;
    const std::string tag = in_quotes(etag);
    for (std::size_t at = header.find(tag); at != std::string::npos; at = header.find(tag, at + 1)) {
        const std::size_t end = at + tag.size();
        const bool starts =
            at == 0 || header[at - 1] == ' ' || header[at - 1] == ',' || header[at - 1] == '/';
        if (starts && (end == header.size() || header[end] == ' ' || header[end] == ',')) return true;
    }
    return false;
}

std::string repr_digest(const std::string& digest)
{
    static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::string hex = digest.substr(digest.find(':') + 1);
    const std::size_t bytes = hex.size() / 2;
    std::string text = "sha-256=:";
    for (std::size_t i = 0; i < bytes; i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 2 * i; k < 2 * i + 6; ++k)
            bits = bits << 4 | (k < hex.size() ? hex_value(hex[k]) : 0);
        const std::size_t count = std::min<std::size_t>(bytes - i, 3); // so many bytes need one letter more
        for (unsigned k = 0; k < 4; ++k)
            text += k <= count ? letters[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text + ":";
}

} // namespace server
