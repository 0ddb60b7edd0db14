// What survives: a node that dies with results in memory alone, a full disk, a job that kills its worker.
#include "tests/server/jobs/faulty_store.h"
#include "tests/server/jobs/job_fixture.h"

#include <thread>

namespace {

using api::JobState;
using tests::DiskFaults;
using tests::FaultyStore;
using tests::Node;

using JobCrash = tests::JobServiceTest;
INSTANTIATE_TEST_SUITE_P(OnDisk, JobCrash, testing::Values("SqliteStore"), [](const auto& suite) {
    return std::string(suite.param);
});

Node::Wrap wrap_in(DiskFaults& faults)
{
    return [&faults](std::unique_ptr<server::Store> real) {
        return std::make_unique<FaultyStore>(std::move(real), faults);
    };
}

TEST_P(JobCrash, RendersTheSameBytesAgainAfterALostResult)
{
    DiskFaults faults;
    faults.no_results = true; // and nothing is released: the node dies with the lease
    std::string id, digest, follower;
    {
        const auto node = open({}, wrap_in(faults));
        id = submit(*node, tests::quick_job()).id;
        follower = submit(*node, tests::quick_job()).id;
        node->jobs.start();
        tests::succeeded(*node, id);
        digest = tests::digest_of_picture(*node, id);
        EXPECT_EQ(tests::digest_of_picture(*node, follower), digest);
    }
    const auto node = open();
    EXPECT_EQ(node->jobs.get(id)->state, JobState::queued);
    node->jobs.start();
    EXPECT_EQ(tests::succeeded(*node, id).attempts, 2U);
    tests::succeeded(*node, follower);
    EXPECT_EQ(tests::digest_of_picture(*node, id), digest);
    EXPECT_EQ(tests::digest_of_picture(*node, follower), digest);
}

TEST_P(JobCrash, ServesFromMemoryUntilTheDiskTakesTheResult)
{
    DiskFaults faults;
    faults.no_results = true;
    const auto node = open({}, wrap_in(faults));
    node->jobs.start();
    const std::string id = submit(*node, tests::quick_job()).id;
    tests::succeeded(*node, id);
    faults.refused_results.wait(0);
    EXPECT_EQ(node->jobs.get(id)->state, JobState::succeeded);
    tests::digest_of_picture(*node, id);
    // The same job, meanwhile, has it too.
    EXPECT_TRUE(tests::succeeded(*node, submit(*node, tests::quick_job()).id).reused);
    // The row cannot be removed before it is there.
    const auto problem = node->jobs.remove(id);
    ASSERT_TRUE(problem);
    EXPECT_EQ(problem->status, 503);
    EXPECT_EQ(problem->code, "still_ending");
    EXPECT_TRUE(problem->retryable);
    faults.no_results = false;
    EXPECT_TRUE(tests::removed(*node, id)); // waits for the row
}

TEST_P(JobCrash, ListsAJobUnderTheStateThatItIsSeenIn)
{
    DiskFaults faults;
    faults.no_results = true;
    const auto node = open({}, wrap_in(faults));
    const std::string oldest = submit(*node, tests::quick_job("", 1)).id;
    node->jobs.start();
    const std::string id = tests::succeeded(*node, submit(*node, tests::quick_job()).id).id;
    tests::succeeded(*node, oldest);
    const std::string follower = tests::succeeded(*node, submit(*node, tests::quick_job()).id).id;
    faults.refused_results.wait(0); // the store still calls them leased and queued
    const auto listed = [&](JobState state, std::uint32_t limit = 50) {
        return tests::expect<std::string>(node->jobs.list({.state = state, .limit = limit}));
    };
    const std::string succeeded = listed(JobState::succeeded);
    for (const std::string& job : {oldest, id, follower}) {
        EXPECT_NE(succeeded.find(job), std::string::npos) << succeeded;
        for (const auto other : {JobState::preparing, JobState::running, JobState::queued})
            EXPECT_EQ(listed(other).find(job), std::string::npos);
    }
    const std::string page = listed(JobState::succeeded, 2);
    EXPECT_NE(page.find(follower), std::string::npos) << "the newest first";
    EXPECT_EQ(page.find(oldest), std::string::npos) << page;
    EXPECT_NE(page.find("next_cursor"), std::string::npos) << page;
}

TEST_P(JobCrash, WaitsWithTheRemovalOfAJobThatIsClaimedButNotYetBegun)
{
    std::string id;
    {
        const auto node = open();
        id = submit(*node, tests::quick_job()).id;
    }
    const auto node = open(); // nothing of it is in memory
    const std::vector<server::Lease> leases = node->store->claim("test", 1, std::chrono::hours(1));
    ASSERT_EQ(leases.size(), 1U);
    const std::jthread worker([&] {
        while (node->jobs.get(id)->state != JobState::canceling)
            std::this_thread::yield();
        node->store->confirm_cancel(leases.front(), 1);
    });
    EXPECT_TRUE(tests::removed(*node, id));
}

TEST_P(JobCrash, TriesAgainAfterTheStoreFailed)
{
    DiskFaults faults;
    const auto node = open({}, wrap_in(faults));
    const std::string id = submit(*node, tests::quick_job()).id;
    faults.lost_reads = 1; // the worker's
    node->jobs.start();
    while (faults.lost_reads != 0)
        std::this_thread::yield();
    EXPECT_EQ(tests::succeeded(*node, id).attempts, 2U);
}

TEST_P(JobCrash, AnswersThatTheDiskIsFull)
{
    DiskFaults faults;
    const auto node = open({}, wrap_in(faults));
    node->jobs.start();
    const std::string kept = submit(*node, tests::quick_job()).id;
    faults.full = true;
    const auto problem =
        tests::refusal(*node, {.body = tests::quick_job("", 5), .part_digests = {}, .idempotency_key = {}});
    EXPECT_EQ(problem.status, 503);
    EXPECT_EQ(problem.code, "storage_full");
    tests::succeeded(*node, kept);
    faults.full = false;
    tests::succeeded(*node, submit(*node, tests::quick_job("", 5)).id);
}

TEST_P(JobCrash, GivesUpOnAJobThatKillsItsWorker)
{
    std::string id;
    for (std::uint32_t death = 0; death < server::kMaxAttempts; ++death) {
        const auto node = open(); // claims, and dies without a word
        if (id.empty()) id = submit(*node, tests::quick_job()).id;
        ASSERT_EQ(node->store->claim("dies", 1, std::chrono::hours(1)).size(), 1U);
    }
    const auto node = open();
    node->jobs.start();
    const api::JobView failed = tests::finished(*node, id);
    ASSERT_EQ(failed.state, JobState::failed);
    EXPECT_EQ(failed.error->code, "too_many_attempts");
    tests::succeeded(*node, submit(*node, tests::quick_job("", 7)).id);
}

TEST_P(JobCrash, RendersAfterARestartWhatNoCacheAskedFor)
{
    std::string id;
    {
        const auto node = open();
        node->jobs.start();
        tests::succeeded(*node, submit(*node, tests::quick_job()).id);
        node->jobs.stop();
    }
    {
        const auto node = open(); // no worker: it dies with the job in the queue
        id = submit(*node, tests::quick_job(), true).id;
    }
    const auto node = open();
    node->jobs.start();
    EXPECT_FALSE(tests::succeeded(*node, id).reused);
}

TEST_P(JobCrash, CancelsAfterARestartWhatWasToBeCanceled)
{
    std::string id;
    {
        const auto node = open();
        id = submit(*node, tests::quick_job()).id;
        ASSERT_EQ(node->store->claim("dies", 1, std::chrono::hours(1)).size(), 1U);
        EXPECT_EQ(node->jobs.cancel(id)->state, JobState::canceling);
    }
    const auto node = open();
    node->jobs.start();
    EXPECT_EQ(tests::finished(*node, id).state, JobState::canceled);
}

TEST_P(JobCrash, TakesUpAStoppedJobAtTheNextStart)
{
    std::string id;
    {
        const auto node = open();
        node->jobs.start();
        id = submit(*node, tests::endless_job()).id;
        tests::running(*node, id);
    }
    const auto node = open();
    EXPECT_EQ(node->jobs.get(id)->state, JobState::queued);
    node->jobs.start();
    EXPECT_EQ(tests::running(*node, id).attempts, 1U);
}

} // namespace
