// The keeping half of the conformance suite: lists, idempotency keys, reuse of results, removal, sweeping.
#include "tests/server/store/store_fixture.h"

#include <algorithm>

namespace {

using server::JobRecord;
using server::Lease;
using server::ListPage;
using server::StoredState;
using server::SubmitStatus;
using tests::a_request;
using tests::a_result;
using tests::kDay_ms;

using StoreKeeping = tests::StoreTest;
INSTANTIATE_TEST_SUITE_P(Every, StoreKeeping, testing::Values("MemStore", "SqliteStore"), tests::store_name);

std::vector<std::string> names_of(const ListPage& page)
{
    std::vector<std::string> names;
    for (const JobRecord& job : page.jobs)
        names.push_back(job.spec.labels.at("name"));
    return names;
}

using Names = std::vector<std::string>;

TEST_P(StoreKeeping, ListsTheNewestFirstAPageAtATime)
{
    for (const char* name : {"a", "b", "c", "d", "e"})
        submit(name);
    const ListPage first = store->list({.tenant = "alice", .limit = 2});
    EXPECT_EQ(names_of(first), (Names{"e", "d"}));
    const ListPage second = store->list({.tenant = "alice", .limit = 2, .cursor = first.next_cursor});
    EXPECT_EQ(names_of(second), (Names{"c", "b"}));
    const ListPage third = store->list({.tenant = "alice", .limit = 2, .cursor = second.next_cursor});
    EXPECT_EQ(names_of(third), (Names{"a"}));
    EXPECT_EQ(third.next_cursor, "");
    EXPECT_EQ(store->list({.tenant = "alice", .limit = 5}).next_cursor, "") << "an exact page is the last";
}

TEST_P(StoreKeeping, KeepsACursorGoodWhileJobsComeAndGo)
{
    std::vector<JobRecord> jobs;
    for (const char* name : {"a", "b", "c", "d"})
        jobs.push_back(submit(name));
    const ListPage first = store->list({.tenant = "alice", .limit = 2});
    submit("newer");
    for (const std::size_t i : {2U, 1U}) { // the page's last and the next one's first
        store->cancel("alice", jobs[i].id, now());
        EXPECT_TRUE(store->remove("alice", jobs[i].id));
    }
    EXPECT_EQ(names_of(store->list({.tenant = "alice", .limit = 2, .cursor = first.next_cursor})),
              (Names{"a"}));
}

TEST_P(StoreKeeping, SaysWhenACursorIsNoneOfItsOwn)
{
    submit("a");
    for (const char* cursor :
         {"x", "c", "c0", "cxyz", "c1 ", "cffffffffffffffff", "c1ffffffffffffffff", "-1"}) {
        const ListPage page = store->list({.tenant = "alice", .cursor = cursor});
        EXPECT_TRUE(page.bad_cursor) << cursor;
        EXPECT_TRUE(page.jobs.empty()) << cursor;
    }
    EXPECT_FALSE(store->list({.tenant = "alice"}).bad_cursor);
}

TEST_P(StoreKeeping, ListsByStateAndByLabel)
{
    succeed("done");
    auto red = a_request("red");
    red.spec.labels["color"] = "red";
    store->submit(red);
    submit("plain");
    EXPECT_EQ(names_of(store->list({.tenant = "alice", .state = StoredState::succeeded})), (Names{"done"}));
    EXPECT_EQ(names_of(store->list({.tenant = "alice", .state = StoredState::queued})),
              (Names{"plain", "red"}));
    EXPECT_EQ(names_of(store->list({.tenant = "alice", .label = std::pair{"color", "red"}})), (Names{"red"}));
    EXPECT_EQ(names_of(store->list({.tenant = "alice", .label = std::pair{"color", "blue"}})), Names{});
    EXPECT_EQ(names_of(store->list({.tenant = "alice", .label = std::pair{"kind", "test"}})),
              (Names{"plain", "red", "done"}));
    EXPECT_EQ(names_of(store->list(
                  {.tenant = "alice", .state = StoredState::queued, .label = std::pair{"name", "done"}})),
              Names{});
}

TEST_P(StoreKeeping, ListsNamedJobsBesideThoseOfAState)
{
    succeed("first");
    const server::JobId named = submit("named").id;
    claim_one();
    succeed("second");
    submit("third");
    auto foreign = a_request("foreign");
    foreign.tenant = "bob";
    server::ListQuery query{.tenant = "alice",
                            .state = StoredState::succeeded,
                            .also = {store->submit(foreign).job.id, named, server::make_job_id()}};
    EXPECT_EQ(names_of(store->list(query)), (Names{"second", "named", "first"}));
    query.limit = 1;
    Names paged;
    do {
        const ListPage page = store->list(query);
        for (const std::string& name : names_of(page))
            paged.push_back(name);
        query.cursor = page.next_cursor;
    } while (!query.cursor.empty());
    EXPECT_EQ(paged, (Names{"second", "named", "first"}));
    query.label = std::pair{"name", "first"};
    EXPECT_EQ(names_of(store->list(query)), (Names{"first"}));
    query.label = std::pair{"name", "named"};
    EXPECT_EQ(names_of(store->list(query)), (Names{"named"}));
    query.state.reset();
    query.label.reset();
    query.limit = 50;
    EXPECT_EQ(store->list(query).jobs.size(), 4U) << "without a state there is nothing to add";
}

TEST_P(StoreKeeping, LeavesTheLongTextsOutOfLists)
{
    succeed("done");
    const JobRecord job = store->list({.tenant = "alice"}).jobs.at(0);
    EXPECT_EQ(job.spec.request_json + job.result->report_json + job.result->scene_json, "");
    EXPECT_EQ(job.result->image_digest, a_result("done").image_digest);
    EXPECT_EQ(job.result->samples, 64U);
    EXPECT_TRUE(job.spec.asset_digests.empty());
}

TEST_P(StoreKeeping, ReplaysARequestWithTheSameKeyAndBody)
{
    auto request = a_request("bunny");
    request.idempotency_key = "key-1";
    const auto first = store->submit(request);
    EXPECT_EQ(first.status, SubmitStatus::accepted);
    store->complete(claim_one(), a_result("bunny"), now());

    const auto replayed = store->submit(request);
    EXPECT_EQ(replayed.status, SubmitStatus::replayed);
    EXPECT_EQ(replayed.job.id, first.job.id);
    EXPECT_EQ(replayed.job.state, StoredState::succeeded);
    EXPECT_EQ(store->list({.tenant = "alice"}).jobs.size(), 1U);

    request.body_digest = "another body";
    EXPECT_EQ(store->submit(request).status, SubmitStatus::key_reused);
    request.tenant = "bob";
    EXPECT_EQ(store->submit(request).status, SubmitStatus::accepted) << "keys belong to a tenant";
}

TEST_P(StoreKeeping, ReplaysEvenWhenTheQueueIsFull)
{
    auto request = a_request("bunny");
    request.idempotency_key = "key-1";
    request.queue_limit = 1;
    const auto first = store->submit(request);
    EXPECT_EQ(store->submit(request).job.id, first.job.id);
}

TEST_P(StoreKeeping, ForgetsAKeyAfterADayOrWithItsJob)
{
    auto request = a_request("bunny");
    request.idempotency_key = "key-1";
    const auto first = store->submit(request).job;
    time.wall_ms += kDay_ms;
    store->sweep(0);
    EXPECT_EQ(store->submit(request).status, SubmitStatus::replayed);
    time.wall_ms += 1;
    store->sweep(0);
    const auto second = store->submit(request);
    EXPECT_EQ(second.status, SubmitStatus::accepted);
    EXPECT_NE(second.job.id, first.id);

    store->cancel("alice", second.job.id, now());
    store->remove("alice", second.job.id);
    EXPECT_EQ(store->submit(request).status, SubmitStatus::accepted);
}

TEST_P(StoreKeeping, GivesANewJobTheResultOfItsTwin)
{
    const JobRecord original = succeed("bunny");
    auto request = a_request("bunny");
    request.queue_limit = 1;
    submit("waits"); // the queue is full: it does not matter to a job that need not wait
    request.now_ms += 5;
    const auto twin = store->submit(request);
    ASSERT_EQ(twin.status, SubmitStatus::accepted);
    EXPECT_NE(twin.job.id, original.id);
    for (const JobRecord& seen : {twin.job, get(twin.job.id)}) {
        EXPECT_EQ(seen.state, StoredState::succeeded);
        EXPECT_TRUE(seen.reused);
        EXPECT_EQ(seen.result->image_digest, a_result("bunny").image_digest);
        EXPECT_EQ(seen.result->samples, 64U);
        EXPECT_EQ(seen.finished_ms, request.now_ms);
        EXPECT_EQ(seen.attempts, 0U);
    }
    EXPECT_EQ(get(twin.job.id).result, a_result("bunny"));
    EXPECT_EQ(store->depth().queued, 1U);
}

TEST_P(StoreKeeping, KeepsATwinsResultWhenTheOtherIsRemoved)
{
    const JobRecord original = succeed("bunny");
    const JobRecord twin = store->submit(a_request("bunny")).job;
    EXPECT_TRUE(store->remove("alice", original.id));
    EXPECT_EQ(get(twin.id).result, a_result("bunny"));
    EXPECT_TRUE(store->shows(a_result("bunny").image_digest));
    EXPECT_TRUE(store->remove("alice", twin.id));
    EXPECT_FALSE(store->shows(a_result("bunny").image_digest));
    EXPECT_TRUE(store->pictures().empty());
}

TEST_P(StoreKeeping, RendersAnewWhereAResultMayNotBeReused)
{
    succeed("bunny");
    auto request = a_request("bunny");
    request.allow_reuse = false;
    EXPECT_EQ(store->submit(request).job.state, StoredState::queued);
    request.allow_reuse = true;
    request.tenant = "bob";
    EXPECT_EQ(store->submit(request).job.state, StoredState::queued) << "another tenant's";
    request.tenant = "alice";
    request.spec.render_key = "";
    EXPECT_EQ(store->submit(request).job.state, StoredState::queued) << "no key";
    EXPECT_EQ(submit("another scene").state, StoredState::queued);
}

TEST_P(StoreKeeping, DoesNotReuseWhatWasStoppedByTime)
{
    submit("bunny");
    server::JobResult stopped = a_result("bunny");
    stopped.reusable = false;
    store->complete(claim_one(), stopped, now());
    EXPECT_FALSE(store->find_result("alice", a_request("bunny").spec.render_key));
    EXPECT_EQ(submit("bunny").state, StoredState::queued);
}

TEST_P(StoreKeeping, LetsAQueuedJobTakeAResult)
{
    auto request = a_request("bunny");
    request.allow_reuse = false;
    const auto first = store->submit(request).job;
    const auto second = store->submit(request).job;
    const Lease lease = claim_one();
    EXPECT_FALSE(store->complete_queued(first.id, a_result("bunny"), now())) << "it is leased";
    EXPECT_TRUE(store->complete(lease, a_result("bunny"), now()));
    EXPECT_EQ(store->find_result("alice", request.spec.render_key), a_result("bunny"));
    EXPECT_TRUE(store->complete_queued(second.id, a_result("bunny"), now() + 4));
    EXPECT_EQ(get(second.id).state, StoredState::succeeded);
    EXPECT_TRUE(get(second.id).reused);
    EXPECT_EQ(get(second.id).result, a_result("bunny"));
    EXPECT_EQ(get(second.id).finished_ms, now() + 4);
    EXPECT_FALSE(store->complete_queued(second.id, a_result("x"), now()));
    EXPECT_FALSE(store->complete_queued("no such job", a_result("x"), now()));
    EXPECT_TRUE(store->claim("worker", 1, tests::kTtl).empty());
}

TEST_P(StoreKeeping, RemovesOnlyFinalJobs)
{
    const auto queued = submit("queued").id;
    EXPECT_FALSE(store->remove("alice", queued));
    const Lease lease = claim_one();
    EXPECT_FALSE(store->remove("alice", queued));
    store->complete(lease, a_result("queued"), now());
    EXPECT_TRUE(store->remove("alice", queued));
    EXPECT_FALSE(store->get("alice", queued));
    EXPECT_FALSE(store->remove("alice", queued));
    EXPECT_TRUE(store->list({.tenant = "alice", .label = std::pair{"name", "queued"}}).jobs.empty());
}

TEST_P(StoreKeeping, SweepsOldResultsAndLongExpiredJobs)
{
    const auto old = succeed("old");
    const auto canceled = submit("canceled");
    store->cancel("alice", canceled.id, now());
    const std::int64_t end_ms = now();
    time.wall_ms += 1000;
    const auto young = succeed("young");
    const auto waiting = submit("waiting");

    EXPECT_EQ(store->sweep(end_ms), 0U) << "what ended then is not older";
    EXPECT_EQ(store->sweep(end_ms + 1), 2U);
    EXPECT_EQ(store->sweep(end_ms + 1), 0U);
    EXPECT_EQ(get(old.id).state, StoredState::expired);
    EXPECT_EQ(get(canceled.id).state, StoredState::expired);
    EXPECT_FALSE(get(old.id).result);
    EXPECT_EQ(get(old.id).finished_ms, end_ms);
    EXPECT_EQ(get(young.id).state, StoredState::succeeded);
    EXPECT_FALSE(store->find_result("alice", old.spec.render_key));
    EXPECT_EQ(submit("old").state, StoredState::queued);

    EXPECT_EQ(store->sweep(end_ms + 7 * kDay_ms + 1), 3U) << "two are forgotten, the young one expires";
    EXPECT_FALSE(store->get("alice", old.id) || store->get("alice", canceled.id));
    EXPECT_EQ(get(young.id).state, StoredState::expired);
    EXPECT_EQ(get(waiting.id).state, StoredState::queued) << "what waits never ages";
}

TEST_P(StoreKeeping, NamesTheDigestsThatAreNeeded)
{
    submit("queued");
    const std::vector<std::string> waiting{"sha256:mesh-of-queued", "sha256:shared"};
    auto digests = store->assets_in_use();
    std::sort(digests.begin(), digests.end());
    EXPECT_EQ(digests, waiting);
    EXPECT_TRUE(store->pictures().empty());
    const Lease lease = claim_one();
    EXPECT_EQ(store->assets_in_use().size(), 2U) << "a leased job needs its assets too";
    store->complete(lease, a_result("queued"), now());
    EXPECT_TRUE(store->assets_in_use().empty());
    EXPECT_EQ(store->pictures(), (std::vector<std::string>{"sha256:picture-of-queued"}));
    store->sweep(now() + 1);
    EXPECT_TRUE(store->pictures().empty());
}

TEST_P(StoreKeeping, CarriesAnyText)
{
    auto request = a_request("bunny");
    request.spec.labels = {
        {"quote", "'; DROP TABLE jobs; --"}, {"unicode", "\xC3\xA9\xF0\x9F\x90\xB0"}, {"", ""}};
    request.spec.request_json = std::string(1 << 20, 'x') + "\"'\\%";
    const auto id = store->submit(request).job.id;
    EXPECT_EQ(get(id).spec.labels, request.spec.labels);
    EXPECT_EQ(get(id).spec.request_json, request.spec.request_json);
    EXPECT_EQ(
        store->list({.tenant = "alice", .label = std::pair{"quote", "'; DROP TABLE jobs; --"}}).jobs.size(),
        1U);
}

} // namespace
