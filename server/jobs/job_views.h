// view_of: a job as its client sees it, from the store's record and what only this process knows.
#pragma once

#include "api/job_view.h"
#include "server/jobs/live_jobs.h"
#include "server/store/store.h"

#include <cstdint>
#include <optional>

namespace server {

// `live` must have been read before `record`: then the record's final state is never older than it.
api::JobView view_of(const JobRecord& record,
                     const std::optional<LiveJob>& live,
                     std::optional<std::uint32_t> queue_position);

// The state under which the store lists, or will list, a job that is seen so.
StoredState stored_state_of(api::JobState seen);
api::JobState state_of(LivePhase phase);

} // namespace server
