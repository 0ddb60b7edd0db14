// The rules that both stores keep, where they are more than a statement: cursors, ages, and which end a job
// comes to.
#pragma once

#include "server/store/store.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace server {

inline constexpr std::int64_t kIdempotencyKept_ms = 24LL * 3600 * 1000;
inline constexpr std::int64_t kExpiredKept_ms = 7LL * 24 * 3600 * 1000; // beyond the retention of results

// A cursor names the last job that was seen by its place in the order of submission, so jobs that come or go
// do not move it.
std::string cursor_after(std::uint64_t sequence);
std::optional<std::uint64_t> sequence_of_cursor(std::string_view cursor);

// The job of an accepted request: succeeded already where a twin's result serves it, else queued.
JobRecord job_of(const SubmitRequest& request, std::optional<JobResult> of_twin);

// Where a leased job goes that its worker gives back, or lost.
StoredState state_when_given_back(bool cancel_requested);
// Where a leased job goes that its worker failed.
StoredState state_when_failed(bool retry, bool cancel_requested, std::uint32_t attempts);

bool is_final(StoredState state);

} // namespace server
