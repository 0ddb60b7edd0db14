// The queue half of the conformance suite: submitting, claiming, fencing, leases, failing, canceling,
// waiting.
#include "tests/server/store/store_fixture.h"

#include <algorithm>
#include <mutex>
#include <set>
#include <thread>

namespace {

using namespace std::chrono_literals;
using server::JobRecord;
using server::Lease;
using server::StoredState;
using server::SubmitStatus;
using tests::a_request;
using tests::a_result;
using tests::kTtl;

using StoreQueue = tests::StoreTest;
INSTANTIATE_TEST_SUITE_P(Every, StoreQueue, testing::Values("MemStore", "SqliteStore"), tests::store_name);

TEST_P(StoreQueue, GivesBackWhatWasSubmitted)
{
    const server::SubmitRequest request = a_request("bunny", 70);
    const JobRecord job = store->submit(request).job;
    for (const JobRecord& seen : {job, get(job.id)}) {
        EXPECT_EQ(seen.id, job.id);
        EXPECT_EQ(seen.tenant, "alice");
        EXPECT_EQ(seen.spec.request_json, request.spec.request_json);
        EXPECT_EQ(seen.spec.render_key, request.spec.render_key);
        EXPECT_EQ(seen.spec.asset_digests, request.spec.asset_digests);
        EXPECT_EQ(seen.spec.priority, 70);
        EXPECT_EQ(seen.spec.labels, request.spec.labels);
        EXPECT_EQ(seen.state, StoredState::queued);
        EXPECT_EQ(seen.epoch, 0U);
        EXPECT_EQ(seen.attempts, 0U);
        EXPECT_EQ(seen.created_ms, request.now_ms);
        EXPECT_FALSE(seen.started_ms || seen.finished_ms || seen.result);
    }
}

TEST_P(StoreQueue, RemembersThatAJobTakesNoOthersResult)
{
    auto request = a_request("alone");
    request.spec.no_cache = true;
    const server::JobRecord alone = store->submit(request).job;
    EXPECT_TRUE(alone.spec.no_cache);
    EXPECT_TRUE(get(alone.id).spec.no_cache);
    EXPECT_TRUE(store->list({.tenant = "alice"}).jobs.at(0).spec.no_cache);
    EXPECT_FALSE(get(submit("other").id).spec.no_cache);
}

TEST_P(StoreQueue, RemembersTheLayersThatAJobWasAskedFor)
{
    auto request = a_request("layered");
    request.spec.layers = 5;
    const server::JobRecord job = store->submit(request).job;
    EXPECT_EQ(job.spec.layers, 5U);
    EXPECT_EQ(get(job.id).spec.layers, 5U);
    EXPECT_EQ(store->list({.tenant = "alice"}).jobs.at(0).spec.layers, 5U);
    EXPECT_EQ(get(submit("other").id).spec.layers, 0U);
}

TEST_P(StoreQueue, LetsTheCallerNameAJobOnce)
{
    auto request = a_request("named");
    request.id = server::make_job_id();
    EXPECT_EQ(store->submit(request).job.id, request.id);
    EXPECT_EQ(get(request.id).spec.request_json, request.spec.request_json);
    EXPECT_THROW(store->submit(request), server::StoreError);
    request.tenant = "bob";
    EXPECT_THROW(store->submit(request), server::StoreError) << "ids are unique over tenants";
    EXPECT_EQ(store->depth().queued, 1U);
    EXPECT_EQ(claim_one().job, request.id);
}

TEST_P(StoreQueue, KnowsNoJobOfAnotherTenant)
{
    const JobRecord job = succeed("mine");
    EXPECT_FALSE(store->get("bob", job.id));
    EXPECT_FALSE(store->cancel("bob", job.id, now()));
    EXPECT_FALSE(store->remove("bob", job.id));
    EXPECT_FALSE(store->find_result("bob", job.spec.render_key));
    EXPECT_TRUE(store->list({.tenant = "bob"}).jobs.empty());
    EXPECT_TRUE(store->get("alice", job.id));
}

TEST_P(StoreQueue, ClaimsTheHighestPriorityAndThenTheOldest)
{
    const auto low = submit("low", 10);
    const auto first = submit("first", 50);
    const auto high = submit("high", 90);
    const auto second = submit("second", 50);
    EXPECT_EQ(store->queue_position(high.id), 0U);
    EXPECT_EQ(store->queue_position(first.id), 1U);
    EXPECT_EQ(store->queue_position(second.id), 2U);
    EXPECT_EQ(store->queue_position(low.id), 3U);
    EXPECT_FALSE(store->queue_position("no such job"));

    std::vector<std::string> order;
    for (const Lease& lease : store->claim("worker", 3, kTtl))
        order.push_back(lease.job);
    order.push_back(claim_one().job);
    EXPECT_EQ(order, (std::vector<std::string>{high.id, first.id, second.id, low.id}));
    EXPECT_TRUE(store->claim("worker", 9, kTtl).empty());
    EXPECT_FALSE(store->queue_position(high.id));
}

TEST_P(StoreQueue, GoesByTheOrderOfSubmissionWhenTheClockJumpsBack)
{
    auto early = a_request("submitted first");
    auto late = a_request("submitted second");
    late.now_ms = early.now_ms - 3'600'000;
    const auto first = store->submit(early).job;
    store->submit(late);
    EXPECT_EQ(claim_one().job, first.id);
}

TEST_P(StoreQueue, CountsQueuedAndLeasedJobs)
{
    submit("a");
    submit("b");
    submit("c");
    claim_one();
    EXPECT_EQ(store->depth().queued, 2U);
    EXPECT_EQ(store->depth().leased, 1U);
}

TEST_P(StoreQueue, CompletesALeasedJob)
{
    const auto id = submit("bunny").id;
    time.wall_ms += 500;
    const Lease lease = claim_one();
    EXPECT_EQ(lease.job, id);
    EXPECT_EQ(lease.epoch, 1U);
    EXPECT_EQ(get(id).state, StoredState::leased);
    EXPECT_EQ(get(id).attempts, 1U);
    EXPECT_EQ(get(id).started_ms, now());
    EXPECT_TRUE(store->complete(lease, a_result("bunny"), now() + 7));
    EXPECT_EQ(get(id).state, StoredState::succeeded);
    EXPECT_EQ(get(id).result, a_result("bunny"));
    EXPECT_EQ(get(id).finished_ms, now() + 7);
    EXPECT_FALSE(get(id).reused);
}

TEST_P(StoreQueue, CompletesAClaimedJobWithAnothersResult)
{
    const auto id = submit("bunny").id;
    EXPECT_TRUE(store->complete(claim_one(), a_result("bunny"), now(), true));
    EXPECT_EQ(get(id).state, StoredState::succeeded);
    EXPECT_TRUE(get(id).reused);
}

TEST_P(StoreQueue, RefusesEveryWordOfAZombie)
{
    const auto id = submit("bunny").id;
    const Lease zombie = claim_one();
    time.steady_ms += kTtl.count();
    const Lease owner = claim_one();
    ASSERT_EQ(owner.job, id);
    EXPECT_EQ(owner.epoch, zombie.epoch + 1);

    EXPECT_EQ(store->renew({zombie}, kTtl), 0U);
    EXPECT_FALSE(store->complete(zombie, a_result("zombie"), now()));
    EXPECT_FALSE(store->fail(zombie, {.summary_json = "{}", .whole_json = "{}"}, false, now()));
    EXPECT_FALSE(store->fail(zombie, {.summary_json = "{}", .whole_json = "{}"}, true, now()));
    EXPECT_FALSE(store->confirm_cancel(zombie, now()));
    store->release({zombie});
    EXPECT_EQ(get(id).state, StoredState::leased);
    EXPECT_EQ(get(id).epoch, owner.epoch);
    EXPECT_EQ(get(id).attempts, 2U);

    EXPECT_EQ(store->renew({owner}, kTtl), 1U) << "the zombie must not have touched the owner's lease";
    EXPECT_TRUE(store->complete(owner, a_result("owner"), now()));
    EXPECT_FALSE(store->complete(owner, a_result("again"), now())) << "a final job has no owner";
    EXPECT_EQ(get(id).result, a_result("owner"));
}

TEST_P(StoreQueue, KeepsALeaseThatIsRenewed)
{
    const auto id = submit("bunny").id;
    const Lease lease = claim_one();
    for (int beat = 0; beat < 3; ++beat) {
        time.steady_ms += kTtl.count() - 1;
        EXPECT_TRUE(store->claim("other", 1, kTtl).empty());
        EXPECT_EQ(store->renew({lease}, kTtl), 1U);
    }
    time.steady_ms += kTtl.count();
    EXPECT_EQ(claim_one().job, id);
}

TEST_P(StoreQueue, LeavesALapsedLeaseToItsOwnerUntilAnotherClaims)
{
    submit("bunny");
    const Lease lease = claim_one();
    time.steady_ms += 10 * kTtl.count();
    EXPECT_TRUE(store->complete(lease, a_result("late"), now()));
}

TEST_P(StoreQueue, TakesAJobBackWithoutCountingTheAttempt)
{
    const auto id = submit("bunny").id;
    const Lease lease = claim_one();
    store->release({lease});
    EXPECT_EQ(get(id).state, StoredState::queued);
    EXPECT_EQ(get(id).attempts, 0U);
    EXPECT_FALSE(get(id).started_ms);
    EXPECT_FALSE(store->complete(lease, a_result("after release"), now()));
    const Lease again = claim_one();
    EXPECT_EQ(again.job, id);
    EXPECT_GT(again.epoch, lease.epoch);
    EXPECT_EQ(get(id).attempts, 1U);
}

TEST_P(StoreQueue, GivesUpAJobAfterFiveAttempts)
{
    const auto id = submit("bunny").id;
    for (std::uint32_t attempt = 1; attempt < server::kMaxAttempts; ++attempt) {
        EXPECT_TRUE(
            store->fail(claim_one(), {.summary_json = "{}", .whole_json = "{\"attempt\":1}"}, true, now()));
        EXPECT_EQ(get(id).state, StoredState::queued);
        EXPECT_EQ(get(id).attempts, attempt);
        EXPECT_EQ(get(id).failure.whole_json, "");
    }
    EXPECT_TRUE(
        store->fail(claim_one(), {.summary_json = "{}", .whole_json = "{\"code\":\"last\"}"}, true, now()));
    EXPECT_EQ(get(id).state, StoredState::failed);
    EXPECT_EQ(get(id).failure.whole_json, "{\"code\":\"last\"}");
    EXPECT_EQ(get(id).finished_ms, now());
    EXPECT_TRUE(store->claim("worker", 1, kTtl).empty());
}

TEST_P(StoreQueue, FailsAJobAtOnceWhenARetryIsHopeless)
{
    const auto id = submit("bunny").id;
    EXPECT_TRUE(store->fail(
        claim_one(), {.summary_json = "{}", .whole_json = "{\"code\":\"broken_mesh\"}"}, false, now()));
    EXPECT_EQ(get(id).state, StoredState::failed);
    EXPECT_EQ(get(id).failure.whole_json, "{\"code\":\"broken_mesh\"}");
}

TEST_P(StoreQueue, CountsAttemptsOfLapsedLeasesSoThatTheWorkerCanGiveUp)
{
    const auto id = submit("crash loop").id;
    for (std::uint32_t attempt = 1; attempt <= server::kMaxAttempts + 1; ++attempt) {
        EXPECT_EQ(claim_one().job, id);
        EXPECT_EQ(get(id).attempts, attempt);
        time.steady_ms += kTtl.count();
    }
    EXPECT_GT(get(id).attempts, server::kMaxAttempts);
}

TEST_P(StoreQueue, CancelsAQueuedJobAtOnce)
{
    const auto id = submit("bunny").id;
    const auto canceled = store->cancel("alice", id, now() + 3);
    ASSERT_TRUE(canceled);
    EXPECT_EQ(canceled->state, StoredState::canceled);
    EXPECT_EQ(canceled->finished_ms, now() + 3);
    EXPECT_TRUE(store->claim("worker", 1, kTtl).empty());
    EXPECT_EQ(store->cancel("alice", id, now() + 9)->finished_ms, now() + 3)
        << "canceling twice changes nothing";
    EXPECT_FALSE(store->cancel("alice", "no such job", now()));
}

TEST_P(StoreQueue, CancelsALeasedJobWhenItsWorkerConfirms)
{
    const auto id = submit("bunny").id;
    const Lease lease = claim_one();
    EXPECT_TRUE(store->cancel("alice", id, now())->cancel_requested);
    EXPECT_EQ(get(id).state, StoredState::leased);
    EXPECT_TRUE(store->confirm_cancel(lease, now()));
    EXPECT_EQ(get(id).state, StoredState::canceled);
    EXPECT_EQ(get(id).finished_ms, now());
}

TEST_P(StoreQueue, KeepsNoResultAfterACancel)
{
    const auto id = submit("bunny").id;
    const Lease lease = claim_one();
    store->cancel("alice", id, now());
    EXPECT_FALSE(store->complete(lease, a_result("too late"), now()));
    EXPECT_EQ(get(id).state, StoredState::canceled);
    EXPECT_FALSE(get(id).result);
}

TEST_P(StoreQueue, EndsACanceledJobWhoseWorkerGivesItBackOrLosesIt)
{
    const auto released = submit("released").id;
    const Lease first = claim_one();
    store->cancel("alice", released, now());
    store->release({first});
    EXPECT_EQ(get(released).state, StoredState::canceled);

    const auto failed = submit("failed").id;
    const Lease second = claim_one();
    store->cancel("alice", failed, now());
    EXPECT_TRUE(store->fail(second, {.summary_json = "{}", .whole_json = "{}"}, true, now()));
    EXPECT_EQ(get(failed).state, StoredState::canceled);

    const auto lost = submit("lost").id;
    claim_one();
    store->cancel("alice", lost, now());
    time.steady_ms += kTtl.count();
    EXPECT_TRUE(store->claim("worker", 1, kTtl).empty());
    EXPECT_EQ(get(lost).state, StoredState::canceled);
}

TEST_P(StoreQueue, RefusesAJobWhenTheQueueIsFull)
{
    auto request = a_request("one");
    request.queue_limit = 2;
    EXPECT_EQ(store->submit(request).status, SubmitStatus::accepted);
    EXPECT_EQ(store->submit(request).status, SubmitStatus::accepted);
    request.idempotency_key = "kept for later";
    EXPECT_EQ(store->submit(request).status, SubmitStatus::queue_full);
    EXPECT_EQ(store->depth().queued, 2U);
    claim_one();
    EXPECT_EQ(store->submit(request).status, SubmitStatus::accepted)
        << "a refused request leaves its key free";
}

TEST_P(StoreQueue, WakesAWaiterWhenAJobComes)
{
    std::thread waiter([&] { store->wait_work(1h, {}); });
    submit("bunny");
    waiter.join();
    store->wait_work(1h, {}); // it waits still, so this returns at once
}

TEST_P(StoreQueue, WakesAWaiterWhenAJobComesBack)
{
    submit("bunny");
    const Lease lease = claim_one();
    std::thread waiter([&] { store->wait_work(1h, {}); });
    store->release({lease});
    waiter.join();
    store->fail(claim_one(), {.summary_json = "{}", .whole_json = "{}"}, true, now());
    store->wait_work(1h, {});
}

TEST_P(StoreQueue, WakesAWaiterWhenALeaseLapsesOrItIsToldToStop)
{
    const auto id = submit("bunny").id;
    store->claim("worker", 1, 20ms);
    store->wait_work(1h, {}); // until then
    time.steady_ms += 20;
    EXPECT_EQ(claim_one().job, id);

    std::jthread waiter([&](std::stop_token stop) { store->wait_work(1h, std::move(stop)); });
    waiter.request_stop();
    waiter.join();
    store->wait_work(1ms, {}); // nothing comes: returns all the same
}

TEST_P(StoreQueue, GivesEachJobToOneOfEightThreads)
{
    constexpr int kJobsEach = 25;
    std::mutex mutex;
    std::multiset<std::string> submitted, claimed;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < kJobsEach; ++i) {
                const auto id = submit("job " + std::to_string(t) + ' ' + std::to_string(i)).id;
                const std::lock_guard lock(mutex);
                submitted.insert(id);
            }
        });
    const auto all_claimed = [&] {
        const std::lock_guard lock(mutex);
        return claimed.size() >= 4 * kJobsEach;
    };
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            while (!all_claimed()) {
                for (const Lease& lease : store->claim("worker", 3, kTtl)) {
                    EXPECT_TRUE(store->complete(lease, a_result(lease.job), now()));
                    const std::lock_guard lock(mutex);
                    claimed.insert(lease.job);
                }
                store->wait_work(10ms, {});
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(claimed, submitted);
    EXPECT_EQ(std::set(claimed.begin(), claimed.end()).size(), claimed.size());
    EXPECT_EQ(store->depth().queued + store->depth().leased, 0U);
}

} // namespace
