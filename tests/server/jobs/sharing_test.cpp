// Jobs with one render key: rendered once, each with an id and an end of its own.
#include "tests/server/jobs/job_fixture.h"

#include <vector>

namespace {

using api::JobState;
using tests::Node;

using SharedRender = tests::JobServiceTest;
INSTANTIATE_TEST_SUITE_P(Every,
                         SharedRender,
                         testing::Values("MemStore", "SqliteStore"),
                         [](const auto& suite) { return std::string(suite.param); });

// Word for word but for the job's own name.
void expect_same_report(Node& node, const std::string& rendered, const std::string& shares)
{
    const auto own = tests::expect<std::string>(node.jobs.report(shares));
    EXPECT_NE(own.find("\"job_id\": \"" + shares + '"'), std::string::npos) << own;
    EXPECT_EQ(own, api::readdress_report(tests::expect<std::string>(node.jobs.report(rendered)), shares));
}

TEST_P(SharedRender, GivesAFinishedResultToALaterJob)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView first = tests::succeeded(*node, submit(*node, tests::quick_job()).id);
    const api::JobView second =
        tests::succeeded(*node, submit(*node, tests::quick_job(R"(,"labels":{"a":"b"})")).id);
    EXPECT_NE(first.id, second.id);
    EXPECT_TRUE(second.reused);
    expect_same_report(*node, first.id, second.id);
    EXPECT_EQ(second.samples_done, first.samples_done);
    EXPECT_EQ(tests::digest_of_picture(*node, first.id), tests::digest_of_picture(*node, second.id));
}

TEST_P(SharedRender, LetsAJobJoinOneThatWaits)
{
    const auto node = open();
    std::vector<api::JobView> jobs;
    for (int i = 0; i < 4; ++i)
        jobs.push_back(submit(*node, tests::quick_job()));
    EXPECT_FALSE(jobs[0].reused);
    EXPECT_TRUE(jobs[3].reused);
    node->jobs.start();
    for (const api::JobView& job : jobs) {
        tests::succeeded(*node, job.id);
        expect_same_report(*node, jobs[0].id, job.id);
        EXPECT_EQ(tests::digest_of_picture(*node, job.id), tests::digest_of_picture(*node, jobs[0].id));
    }
    node->jobs.stop();
    for (std::size_t i = 0; i < jobs.size(); ++i) { // and the store knows
        EXPECT_EQ(node->store->get({}, jobs[i].id)->state, server::StoredState::succeeded);
        EXPECT_EQ(node->store->get({}, jobs[i].id)->reused, i != 0);
    }
}

TEST_P(SharedRender, RendersAnewWhereNoCacheAsksForIt)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView first = tests::succeeded(*node, submit(*node, tests::quick_job()).id);
    const api::JobView second = tests::succeeded(*node, submit(*node, tests::quick_job(), true).id);
    EXPECT_FALSE(second.reused);
    EXPECT_EQ(second.attempts, 1U);
    EXPECT_EQ(tests::digest_of_picture(*node, first.id), tests::digest_of_picture(*node, second.id));
}

TEST_P(SharedRender, DoesNotOfferWhatTimeStopped)
{
    const auto node = open();
    node->jobs.start();
    const std::string body =
        R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":64,"height":64},"quality":{"time_s":0.02}})";
    const api::JobView first = tests::succeeded(*node, submit(*node, body).id);
    const api::JobView second = tests::succeeded(*node, submit(*node, body).id);
    EXPECT_EQ(first.render_key, second.render_key);
    EXPECT_FALSE(second.reused);
}

TEST_P(SharedRender, OutlivesTheJobThatMadeIt)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView first = tests::succeeded(*node, submit(*node, tests::quick_job()).id);
    const api::JobView second = tests::succeeded(*node, submit(*node, tests::quick_job()).id);
    const std::string digest = tests::digest_of_picture(*node, first.id);
    EXPECT_TRUE(tests::removed(*node, first.id));
    EXPECT_EQ(tests::digest_of_picture(*node, second.id), digest);
    EXPECT_TRUE(node->blobs.has(server::BlobStore::Kind::result, tests::blob_of(*node->store, second.id)));
}

TEST_P(SharedRender, GoesOnWhenTheFirstIsCanceled)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView first = submit(*node, tests::endless_job());
    tests::running(*node, first.id);
    const api::JobView second = submit(*node, tests::endless_job());
    EXPECT_TRUE(second.reused);
    node->jobs.cancel(first.id);
    EXPECT_EQ(tests::finished(*node, first.id).state, JobState::canceled);
    EXPECT_FALSE(tests::running(*node, second.id).reused);
    node->jobs.cancel(second.id);
    EXPECT_EQ(tests::finished(*node, second.id).state, JobState::canceled);
}

} // namespace
