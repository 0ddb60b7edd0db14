// Reading a request's body within a limit, whoever frames it: bytes are counted as they come.
#pragma once

#include "renderer/description/limits.h"
#include "server/http/exchange.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace server {

// 413 that names the limit, its value and the flag that raises it. `what` begins the sentence: "the JSON
// body".
api::ProblemDetails over_limit(std::string_view what, std::string_view limit, const renderer::Limits& limits);

// 411 where the head tells neither length nor chunks.
std::optional<api::ProblemDetails> refuse_without_length(const Exchange& exchange, const std::string& what);
// The same, and 413 when the length is over the limit.
std::optional<api::ProblemDetails> refuse_by_head(const Exchange& exchange,
                                                  const std::string& what,
                                                  std::string_view limit,
                                                  const renderer::Limits& limits);

// Gives the body to `take` piece by piece. 400 when it ends before it is complete; whether `take` stopped it
// (by false) is for the caller to know, and then nothing is returned.
std::optional<api::ProblemDetails> read_body(const Exchange& exchange,
                                             const std::function<bool(std::string_view)>& take);

} // namespace server
