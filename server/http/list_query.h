// Reading the query of GET /v1/jobs, every fault of it at once.
#pragma once

#include "server/http/exchange.h"
#include "server/jobs/job_service.h"

#include <string>
#include <variant>
#include <vector>

namespace server {

std::vector<std::string> list_query_keys();
std::variant<ListWords, std::vector<api::Problem>> read_list_query(const Exchange& exchange);

} // namespace server
