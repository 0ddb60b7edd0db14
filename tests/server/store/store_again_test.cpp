// A job that succeeded and whose picture was lost waits again: what every store does with it.
#include "tests/server/store/store_fixture.h"

#include <algorithm>
#include <future>

namespace {

using server::StoredState;
using tests::a_request;
using tests::a_result;
using tests::kTtl;

using StoreAgain = tests::StoreTest;
INSTANTIATE_TEST_SUITE_P(Every, StoreAgain, testing::Values("MemStore", "SqliteStore"), tests::store_name);

TEST_P(StoreAgain, QueuesAJobAsIfItHadNeverBeenTried)
{
    const server::JobId id = succeed("lost").id;
    const std::uint64_t epoch = get(id).epoch;
    EXPECT_TRUE(store->render_again("alice", id, a_result("lost").image_digest));
    const server::JobRecord waiting = get(id);
    EXPECT_EQ(waiting.state, StoredState::queued);
    EXPECT_EQ(waiting.attempts, 0U);
    EXPECT_FALSE(waiting.result || waiting.started_ms || waiting.finished_ms);
    EXPECT_EQ(waiting.spec.request_json, a_request("lost").spec.request_json);
    EXPECT_EQ(store->queue_position(id), 0U);
    EXPECT_FALSE(store->find_result("alice", a_request("lost").spec.render_key));

    const server::Lease lease = claim_one();
    EXPECT_EQ(lease.job, id);
    EXPECT_GT(lease.epoch, epoch);
    EXPECT_TRUE(store->complete(lease, a_result("lost"), now()));
    EXPECT_EQ(get(id).result, a_result("lost"));
    EXPECT_EQ(get(id).attempts, 1U);
}

TEST_P(StoreAgain, NeedsItsAssetsAgain)
{
    const server::JobId id = succeed("lost").id;
    store->render_again("alice", id, a_result("lost").image_digest);
    const std::vector<std::string> needed = store->assets_in_use();
    EXPECT_EQ(std::count(needed.begin(), needed.end(), "sha256:mesh-of-lost"), 1);
    EXPECT_FALSE(store->shows(a_result("lost").image_digest));
    store->sweep(now() + 100 * tests::kDay_ms);
    EXPECT_EQ(get(id).state, StoredState::queued) << "what waits does not expire";
}

TEST_P(StoreAgain, ForgetsThatAResultWasAnothers)
{
    succeed("lost");
    const server::JobId twin = submit("lost").id;
    EXPECT_TRUE(get(twin).reused);
    EXPECT_TRUE(store->render_again("alice", twin, a_result("lost").image_digest));
    EXPECT_FALSE(get(twin).reused);
    EXPECT_TRUE(store->find_result("alice", a_request("lost").spec.render_key)) << "the other's";
}

TEST_P(StoreAgain, QueuesOnlyWhatSucceededWithThatPicture)
{
    const server::JobId done = succeed("done").id;
    const std::string digest = a_result("done").image_digest;
    EXPECT_FALSE(store->render_again("alice", done, "sha256:another"));
    EXPECT_FALSE(store->render_again("bob", done, digest));
    EXPECT_FALSE(store->render_again("alice", server::make_job_id(), digest));
    EXPECT_EQ(get(done).state, StoredState::succeeded);
    const server::JobId failing = submit("failing").id;
    EXPECT_FALSE(store->render_again("alice", failing, digest));
    store->fail(claim_one(), {.summary_json = "{}", .whole_json = "{}"}, false, now());
    EXPECT_FALSE(store->render_again("alice", failing, digest));
    EXPECT_TRUE(store->render_again("alice", done, digest));
    EXPECT_FALSE(store->render_again("alice", done, digest)) << "it waits already";
}

TEST_P(StoreAgain, WakesAWaiter)
{
    const server::JobId id = succeed("lost").id;
    auto woken = std::async(std::launch::async, [&] { store->wait_work(std::chrono::hours(1), {}); });
    store->render_again("alice", id, a_result("lost").image_digest);
    woken.get();
}

} // namespace
