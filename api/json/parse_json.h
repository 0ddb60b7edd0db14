// parse_json: the one place where bytes from outside become JSON: bounded in size, depth and number of
// values.
//
// Refused  what is not JSON or not UTF-8, a member written twice, numbers that are not finite (1e400, NaN),
//          nesting and counts over the limits. Strictly JSON: no comments, no trailing commas.
// Errors   400 malformed_json or 413 over_limit, with line, column and pointer. Throws only std::bad_alloc.
// Cost     one pass, iterative: depth never uses the stack.
#pragma once

#include "api/json/json.h"
#include "api/problem.h"
#include "renderer/description/limits.h"

#include <string_view>
#include <variant>

namespace api {

std::variant<Json, ProblemDetails> parse_json(std::string_view text, const renderer::Limits& limits);

} // namespace api
