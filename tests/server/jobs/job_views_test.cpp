#include "server/jobs/job_views.h"

#include <gtest/gtest.h>

namespace {

using api::JobState;
using server::JobOutcome;
using server::JobRecord;
using server::LiveJob;
using server::LivePhase;
using server::StoredState;
using server::view_of;

JobRecord record(StoredState state)
{
    JobRecord job;
    job.id = "0123";
    job.state = state;
    job.attempts = 1;
    job.spec.render_key = "sha256:key";
    job.spec.labels = {{"color", "red"}};
    job.created_ms = 10;
    return job;
}

LiveJob ended(LivePhase phase)
{
    auto outcome = std::make_shared<JobOutcome>();
    outcome->phase = phase;
    outcome->finished_ms = 30;
    outcome->result.samples = 64;
    outcome->error.code = "time_limit";
    return {.phase = phase, .outcome = std::move(outcome)};
}

TEST(JobView, TellsWhatTheStoreKnows)
{
    const std::pair<StoredState, JobState> pairs[] = {{StoredState::queued, JobState::queued},
                                                      {StoredState::leased, JobState::preparing},
                                                      {StoredState::succeeded, JobState::succeeded},
                                                      {StoredState::failed, JobState::failed},
                                                      {StoredState::canceled, JobState::canceled},
                                                      {StoredState::expired, JobState::expired}};
    for (const auto& [stored, seen] : pairs)
        EXPECT_EQ(view_of(record(stored), {}, {}).state, seen);
    JobRecord job = record(StoredState::leased);
    job.cancel_requested = true;
    EXPECT_EQ(view_of(job, {}, {}).state, JobState::canceling);
    job = record(StoredState::succeeded);
    job.result.emplace();
    job.result->samples = 16;
    const api::JobView view = view_of(job, {}, 3);
    EXPECT_EQ(view.id, "0123");
    EXPECT_EQ(view.progress, 1);
    EXPECT_EQ(view.samples_done, 16U);
    EXPECT_EQ(view.labels.at("color"), "red");
    EXPECT_FALSE(view.queue_position) << "it waits no more";
    EXPECT_EQ(view_of(record(StoredState::queued), {}, 3).queue_position, 3U);
}

TEST(JobView, TellsWhatOnlyMemoryKnows)
{
    const LiveJob running{
        .phase = LivePhase::running, .progress = 0.5, .samples = 8, .joined = false, .started_ms = 20};
    const api::JobView view = view_of(record(StoredState::leased), running, {});
    EXPECT_EQ(view.state, JobState::running);
    EXPECT_EQ(view.progress, 0.5);
    EXPECT_EQ(view.samples_done, 8U);
    EXPECT_EQ(view.started_ms, 20);
    const LiveJob waiting{.phase = LivePhase::queued, .joined = true};
    EXPECT_TRUE(view_of(record(StoredState::queued), waiting, {}).reused);
    EXPECT_EQ(view_of(record(StoredState::leased), waiting, {}).state, JobState::preparing)
        << "claimed, and the worker has not said so yet";
}

TEST(JobView, TellsAnEndThatIsNotYetStored)
{
    const api::JobView done = view_of(record(StoredState::leased), ended(LivePhase::succeeded), {});
    EXPECT_EQ(done.state, JobState::succeeded);
    EXPECT_EQ(done.progress, 1);
    EXPECT_EQ(done.samples_done, 64U);
    EXPECT_EQ(done.finished_ms, 30);
    EXPECT_FALSE(done.error);
    const api::JobView failed = view_of(record(StoredState::leased), ended(LivePhase::failed), {});
    EXPECT_EQ(failed.state, JobState::failed);
    EXPECT_EQ(failed.error->code, "time_limit");
    EXPECT_EQ(view_of(record(StoredState::queued), ended(LivePhase::canceled), {}).state, JobState::canceled);
}

TEST(JobView, BelievesTheStoreOnceItKnowsTheEnd)
{
    const LiveJob running{.phase = LivePhase::running, .progress = 0.5};
    EXPECT_EQ(view_of(record(StoredState::succeeded), running, {}).state, JobState::succeeded);
    EXPECT_EQ(view_of(record(StoredState::expired), ended(LivePhase::succeeded), {}).state,
              JobState::expired);
}

} // namespace
