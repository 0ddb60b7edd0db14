#include "server/http/body.h"

#include "api/words/limit_words.h"

#include <charconv>

namespace server {

api::ProblemDetails over_limit(std::string_view what, std::string_view limit, const renderer::Limits& limits)
{
    return problem(413, "over_limit", api::over_limit_words(what, limit, limits));
}

std::optional<api::ProblemDetails> refuse_without_length(const Exchange& exchange, const std::string& what)
{
    if (exchange.has_header("Transfer-Encoding") || exchange.has_header("Content-Length"))
        return std::nullopt;
    return problem(411, "length_required", what + " needs a Content-Length, or Transfer-Encoding: chunked");
}

std::optional<api::ProblemDetails> refuse_by_head(const Exchange& exchange,
                                                  const std::string& what,
                                                  std::string_view limit,
                                                  const renderer::Limits& limits)
{
    if (auto refusal = refuse_without_length(exchange, what)) return refusal;
    const std::string text = exchange.header("Content-Length");
    std::uint64_t length = 0;
    std::from_chars(text.data(), text.data() + text.size(), length);
    if (length > api::value_of(limit, limits)) return over_limit(what, limit, limits);
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
