#include "server/jobs/live_jobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <future>

namespace {

using namespace std::chrono_literals;
using server::JobOutcome;
using server::LiveJobs;
using server::LivePhase;
using server::OutcomePtr;
using server::Sharing;
using server::StopCause;

using Until = LiveJobs::Until;

constexpr auto kPatience = 60s;

std::chrono::steady_clock::time_point in(std::chrono::milliseconds time)
{
    return std::chrono::steady_clock::now() + time;
}

Sharing shares(const std::string& key)
{
    return {.render_key = key};
}

JobOutcome success(const std::string& digest = "sha256:picture", bool reusable = true)
{
    JobOutcome outcome{.phase = LivePhase::succeeded};
    outcome.result.image_digest = digest;
    outcome.result.reusable = reusable;
    return outcome;
}

TEST(LiveJobs, FollowAJobFromItsSubmitToItsEnd)
{
    LiveJobs live;
    EXPECT_FALSE(live.snapshot("a").job);
    EXPECT_FALSE(live.add("a", shares("key")));
    EXPECT_EQ(live.snapshot("a").job->phase, LivePhase::queued);
    EXPECT_TRUE(live.begin("a", 42).stop.stop_possible());
    EXPECT_EQ(live.snapshot("a").job->phase, LivePhase::preparing);
    EXPECT_EQ(live.snapshot("a").job->started_ms, 42);
    live.set_running("a");
    live.set_progress("a", 0.5, 8);
    EXPECT_EQ(live.snapshot("a").job->phase, LivePhase::running);
    EXPECT_EQ(live.snapshot("a").job->progress, 0.5);
    EXPECT_EQ(live.snapshot("a").job->samples, 8U);
    EXPECT_EQ(live.finish("a", success()).outcome->phase, LivePhase::succeeded);
    EXPECT_EQ(live.snapshot("a").job->phase, LivePhase::succeeded);
    EXPECT_EQ(live.image_digests(), std::vector<std::string>{"sha256:picture"});
    live.forget("a");
    EXPECT_FALSE(live.snapshot("a").job);
    EXPECT_TRUE(live.image_digests().empty());
}

TEST(LiveJobs, KnowNothingOfWhatIsNotWorkedOn)
{
    LiveJobs live;
    live.add("queued", shares("key"));
    for (const char* id : {"queued", "unknown"}) {
        live.set_running(id);
        live.set_progress(id, 0.5, 8);
        EXPECT_FALSE(live.request_stop(id, StopCause::cancel));
        EXPECT_EQ(live.stop_cause(id), StopCause::none);
    }
    EXPECT_EQ(live.snapshot("queued").job->phase, LivePhase::queued);
    EXPECT_EQ(live.snapshot("queued").job->progress, 0);
    EXPECT_FALSE(live.snapshot("unknown").job);
}

TEST(LiveJobs, StopForTheFirstCause)
{
    LiveJobs live;
    const std::stop_token stop = live.begin("a", 1).stop;
    EXPECT_TRUE(live.request_stop("a", StopCause::time_limit));
    EXPECT_TRUE(stop.stop_requested());
    EXPECT_TRUE(live.request_stop("a", StopCause::cancel));
    EXPECT_EQ(live.stop_cause("a"), StopCause::time_limit);
    EXPECT_EQ(live.snapshot("a").job->phase, LivePhase::preparing) << "not canceling";
    // Begun anew, nothing of that is left.
    live.requeue("a");
    EXPECT_EQ(live.snapshot("a").job->phase, LivePhase::queued);
    EXPECT_FALSE(live.begin("a", 2).stop.stop_requested());
    EXPECT_EQ(live.stop_cause("a"), StopCause::none);
}

TEST(LiveJobs, StopAllThatAreWorkedOn)
{
    LiveJobs live;
    live.add("queued", shares("key"));
    const std::stop_token one = live.begin("one", 1).stop, two = live.begin("two", 1).stop;
    live.stop_all(StopCause::drain);
    EXPECT_TRUE(one.stop_requested() && two.stop_requested());
    EXPECT_EQ(live.stop_cause("one"), StopCause::drain);
    EXPECT_EQ(live.stop_cause("queued"), StopCause::none);
}

TEST(LiveJobs, EndAsCanceledWhereTheCancelCameFirst)
{
    LiveJobs live;
    live.begin("a", 1);
    live.request_stop("a", StopCause::cancel);
    EXPECT_EQ(live.snapshot("a").job->phase, LivePhase::canceling);
    EXPECT_EQ(live.finish("a", success()).outcome->phase, LivePhase::canceled);
    EXPECT_TRUE(live.image_digests().empty());
    EXPECT_FALSE(live.request_stop("a", StopCause::cancel)) << "it has ended";
}

TEST(LiveJobs, GiveAnOutcomeToWhoWaitsWithTheSameKey)
{
    LiveJobs live;
    live.add("first", shares("key"));
    live.add("follower", shares("key"));
    live.add("alone", {.render_key = "key", .takes_results = false});
    live.add("other", shares("other key"));
    EXPECT_FALSE(live.snapshot("first").job->joined);
    EXPECT_TRUE(live.snapshot("follower").job->joined);
    EXPECT_FALSE(live.snapshot("alone").job->joined);
    live.begin("first", 1);
    const LiveJobs::Settled settled = live.finish("first", success());
    EXPECT_EQ(settled.followers, std::vector<std::string>{"follower"});
    EXPECT_EQ(live.snapshot("follower").job->outcome, settled.outcome);
    EXPECT_TRUE(live.snapshot("follower").job->joined);
    EXPECT_FALSE(live.snapshot("first").job->joined);
    EXPECT_FALSE(live.snapshot("alone").job->outcome);
    EXPECT_FALSE(live.snapshot("other").job->outcome);
    // A follower that is claimed nevertheless has nothing to do.
    EXPECT_EQ(live.begin("follower", 2).outcome, settled.outcome);
    // One that comes while the outcome is not yet stored has it at once.
    EXPECT_EQ(live.add("late", shares("key")), settled.outcome);
    EXPECT_EQ(live.snapshot("late").job->phase, LivePhase::succeeded);
}

TEST(LiveJobs, ShareNoFailureAndOfferNothingThatTimeStopped)
{
    LiveJobs live;
    live.add("first", shares("key"));
    live.add("follower", shares("key"));
    live.begin("first", 1);
    EXPECT_TRUE(live.finish("first", {.phase = LivePhase::failed}).followers.empty());
    EXPECT_EQ(live.snapshot("follower").job->phase, LivePhase::queued);
    live.begin("follower", 1);
    live.finish("follower", success("sha256:hasty", false));
    EXPECT_FALSE(live.add("late", shares("key")));
}

TEST(LiveJobs, KeepSamplesThatAreNotFiniteFromWhoFailsOnThem)
{
    LiveJobs live;
    live.add("first", shares("key"));
    live.add("strict", {.render_key = "key", .fails_on_non_finite = true});
    live.add("follower", shares("key"));
    live.begin("first", 1);
    JobOutcome outcome = success();
    outcome.non_finite_samples = 1;
    EXPECT_EQ(live.finish("first", std::move(outcome)).followers, std::vector<std::string>{"follower"});
    EXPECT_FALSE(live.add("strict too", {.render_key = "key", .fails_on_non_finite = true}));
}

TEST(LiveJobs, LetWhatWasSaidAtSubmitStand)
{
    LiveJobs live;
    live.add("a", {.render_key = "key", .takes_results = false});
    EXPECT_FALSE(live.describe("a", shares("key")).sharing.takes_results);
    EXPECT_TRUE(live.describe("of an earlier process", shares("key")).sharing.takes_results);
    live.add("b", shares("key"));
    EXPECT_TRUE(live.snapshot("b").job->joined);
}

TEST(LiveJobs, GiveAnOutcomeToAJobOfAnEarlierProcess)
{
    LiveJobs live;
    for (const char* id : {"first", "second", "alone"})
        live.begin(id, 1);
    EXPECT_FALSE(live.describe("first", shares("key")).outcome);
    const OutcomePtr outcome = live.finish("first", success()).outcome;
    EXPECT_EQ(live.describe("second", shares("key")).outcome, outcome);
    EXPECT_TRUE(live.snapshot("second").job->joined);
    EXPECT_FALSE(live.describe("alone", {.render_key = "key", .takes_results = false}).outcome);
    live.begin("canceled", 1);
    live.request_stop("canceled", StopCause::cancel);
    EXPECT_FALSE(live.describe("canceled", shares("key")).outcome);
}

TEST(LiveJobs, JoinNothingThatIsBeingCanceled)
{
    LiveJobs live;
    live.add("first", shares("key"));
    live.begin("first", 1);
    live.request_stop("first", StopCause::cancel);
    live.add("second", shares("key"));
    EXPECT_FALSE(live.snapshot("second").job->joined);
}

TEST(LiveJobs, WakeWhoWaitsForAChangeAtEachAndWhoWaitsForTheEndThenAlone)
{
    LiveJobs live;
    live.add("a", shares("key"));
    live.begin("a", 1);
    const LiveJobs::Mark mark = live.snapshot("a").mark;
    auto end =
        std::async(std::launch::async, [&] { return live.wait("a", mark, in(kPatience), Until::end); });
    auto change =
        std::async(std::launch::async, [&] { return live.wait("a", mark, in(kPatience), Until::change); });
    live.set_progress("a", 0.5, 1);
    EXPECT_TRUE(change.get());
    live.set_running("a");
    EXPECT_TRUE(live.wait("a", mark, in(kPatience), Until::change)) << "it has changed since the mark";
    EXPECT_FALSE(live.wait("a", mark, in(1ms), Until::end)) << "running is no end";
    const LiveJobs::Mark running = live.snapshot("a").mark;
    live.set_progress("a", 0.5, 1); // no news
    EXPECT_FALSE(live.wait("a", running, in(1ms), Until::change));
    live.finish("a", {});
    EXPECT_TRUE(end.get());
    EXPECT_TRUE(live.wait("a", mark, in(kPatience), Until::end)) << "it has ended since the mark";
}

TEST(LiveJobs, WakeWhoWaitsForAJobOfAnEarlierProcessWhenItEnds)
{
    LiveJobs live;
    const LiveJobs::Mark mark = live.snapshot("old").mark;
    EXPECT_FALSE(live.wait("old", mark, in(1ms), Until::end));
    live.begin("old", 1);
    EXPECT_FALSE(live.wait("old", mark, in(1ms), Until::end));
    EXPECT_TRUE(live.wait("old", mark, in(kPatience), Until::change));
    live.finish("old", {});
    EXPECT_TRUE(live.wait("old", mark, in(kPatience), Until::end));
}

TEST(LiveJobs, WakeWhoWaitsForAnEntryToGo)
{
    LiveJobs live;
    live.add("a", shares("key"));
    EXPECT_FALSE(live.wait_forgotten("a", in(1ms)));
    const LiveJobs::Mark mark = live.snapshot("a").mark;
    auto gone = std::async(std::launch::async, [&] { return live.wait_forgotten("a", in(kPatience)); });
    live.forget("a");
    EXPECT_TRUE(gone.get());
    EXPECT_TRUE(live.wait("a", mark, in(kPatience), Until::end));
}

TEST(LiveJobs, LetNobodyWaitOnceClosed)
{
    LiveJobs live;
    live.add("a", shares("key"));
    const LiveJobs::Mark mark = live.snapshot("a").mark;
    auto waiting =
        std::async(std::launch::async, [&] { return live.wait("a", mark, in(kPatience), Until::change); });
    live.close();
    EXPECT_FALSE(waiting.get());
    EXPECT_FALSE(live.wait("a", mark, in(kPatience), Until::change));
}

} // namespace
