// Problem details as a JSON value, for answers that carry one within.
#pragma once

#include "api/json/json.h"
#include "api/problem.h"

namespace api {

Json problem_json(const ProblemDetails& problem);
Json fault_json(const Problem& fault);

} // namespace api
