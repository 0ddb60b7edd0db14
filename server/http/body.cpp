#include "server/http/body.h"

#include "api/words/limit_words.h"

#include <algorithm>
#include <charconv>

namespace server {

api::ProblemDetails
over_limit(const std::string& what, std::uint64_t renderer::Limits::*limit, const renderer::Limits& limits)
{
    const auto& entry = *std::find_if(renderer::limit_table().begin(),
                                      renderer::limit_table().end(),
                                      [&](const auto& row) { return row.value == limit; });
    const std::string unit = *entry.unit != '\0' ? std::string(" ") + entry.unit : std::string();
    return problem(413,
                   "too_large",
                   what + " is over the limit " + entry.name + ", " + std::to_string(limits.*limit) + unit +
                       "; the service's flag " + api::flag_of(entry.name) + " raises it");
}

std::optional<api::ProblemDetails> refuse_without_length(const Exchange& exchange, const std::string& what)
{
    if (exchange.has_header("Transfer-Encoding") || exchange.has_header("Content-Length"))
        return std::nullopt;
    return problem(411, "length_required", what + " needs a Content-Length, or Transfer-Encoding: chunked");
}

std::optional<api::ProblemDetails> refuse_by_head(const Exchange& exchange,
                                                  const std::string& what,
                                                  std::uint64_t renderer::Limits::*limit,
                                                  const renderer::Limits& limits)
{
    if (auto refusal = refuse_without_length(exchange, what)) return refusal;
    const std::string text = exchange.header("Content-Length");
    std::uint64_t length = 0;
    std::from_chars(text.data(), text.data() + text.size(), length);
    if (length > limits.*limit) return over_limit(what, limit, limits);
    return std::nullopt;
}

std::optional<api::ProblemDetails> read_body(const Exchange& exchange,
                                             const std::function<bool(std::string_view)>& take)
{
    bool stopped = false;
    const bool complete = (*exchange.content)([&](const char* data, std::size_t size) {
        stopped = stopped || !take({data, size});
        return !stopped;
    });
    // httplib leaves a status of its own when reading failed; ours is set by the reply.
    exchange.response.status = -1;
    if (complete || stopped) return std::nullopt;
    return problem(
        400,
        "bad_request",
        "the body ended early, came too slowly, or is not in the chunks that Transfer-Encoding promises");
}

} // namespace server
