#include "server/jobs/job_views.h"

#include "server/store/store_rules.h"

#include <utility>

namespace server {

namespace {

api::JobState state_of(const JobRecord& record)
{
    switch (record.state) {
    case StoredState::queued:
        return api::JobState::queued;
    case StoredState::leased:
        return record.cancel_requested ? api::JobState::canceling : api::JobState::preparing;
    case StoredState::succeeded:
        return api::JobState::succeeded;
    case StoredState::failed:
        return api::JobState::failed;
    case StoredState::canceled:
        return api::JobState::canceled;
    case StoredState::expired:
        return api::JobState::expired;
    }
    return api::JobState::queued;
}

api::JobView stored_view(const JobRecord& record)
{
    api::JobView view;
    view.id = record.id;
    view.state = state_of(record);
    view.created_ms = record.created_ms;
    view.started_ms = record.started_ms;
    view.finished_ms = record.finished_ms;
    view.reused = record.reused;
    view.render_key = record.spec.render_key;
    view.priority = record.spec.priority;
    view.labels = record.spec.labels;
    view.attempts = record.attempts;
    view.layers = {record.spec.layers};
    if (record.result) {
        view.progress = 1;
        view.samples_done = record.result->samples;
    }
    api::ProblemDetails error;
    const JobFailure& failure = record.failure;
    const std::string& told = failure.whole_json.empty() ? failure.summary_json : failure.whole_json;
    if (!told.empty() && api::read_problem(told, error)) view.error = std::move(error);
    return view;
}

void add_outcome(api::JobView& view, const JobOutcome& outcome)
{
    view.finished_ms = outcome.finished_ms;
    if (outcome.phase == LivePhase::failed) view.error = outcome.error;
    if (outcome.phase != LivePhase::succeeded) return;
    view.progress = 1;
    view.samples_done = outcome.result.samples;
}

} // namespace

api::JobState state_of(LivePhase phase)
{
    switch (phase) {
    case LivePhase::queued:
        return api::JobState::queued;
    case LivePhase::preparing:
        return api::JobState::preparing;
    case LivePhase::running:
        return api::JobState::running;
    case LivePhase::canceling:
        return api::JobState::canceling;
    case LivePhase::succeeded:
        return api::JobState::succeeded;
    case LivePhase::failed:
        return api::JobState::failed;
    case LivePhase::canceled:
        return api::JobState::canceled;
    }
    return api::JobState::queued;
}

StoredState stored_state_of(api::JobState seen)
{
    switch (seen) {
    case api::JobState::queued:
        return StoredState::queued;
    case api::JobState::preparing:
    case api::JobState::running:
    case api::JobState::canceling:
        return StoredState::leased;
    case api::JobState::succeeded:
        return StoredState::succeeded;
    case api::JobState::failed:
        return StoredState::failed;
    case api::JobState::canceled:
        return StoredState::canceled;
    case api::JobState::expired:
        return StoredState::expired;
    }
    return StoredState::queued;
}

api::JobView view_of(const JobRecord& record,
                     const std::optional<LiveJob>& live,
                     std::optional<std::uint32_t> queue_position)
{
    api::JobView view = stored_view(record);
    if (live && !is_final(record.state) &&
        !(live->phase == LivePhase::queued && record.state == StoredState::leased)) {
        view.state = state_of(live->phase);
        view.progress = live->progress;
        view.samples_done = live->samples;
        view.reused = live->joined;
        if (!view.started_ms)
            view.started_ms = live->started_ms; // the claim is the same moment, but for a tick
        if (live->outcome) add_outcome(view, *live->outcome);
    }
    if (view.state == api::JobState::queued) view.queue_position = queue_position;
    return view;
}

} // namespace server
