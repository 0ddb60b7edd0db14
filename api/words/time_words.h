// Times in answers: RFC 3339 in UTC with milliseconds.
#pragma once

#include <cstdint>
#include <string>

namespace api {

// "2026-03-01T12:00:00.250Z"; `unix_ms` within the years 0 to 9999, others are clamped.
std::string rfc3339(std::int64_t unix_ms);

} // namespace api
