// How a store lets results go, and what it reads for whom.
#include "tests/server/store/store_fixture.h"

namespace {

using server::JobRecord;
using server::StoredState;
using tests::a_request;
using tests::a_result;

using StoreRoom = tests::StoreTest;
INSTANTIATE_TEST_SUITE_P(Every, StoreRoom, testing::Values("MemStore", "SqliteStore"), tests::store_name);

TEST_P(StoreRoom, ExpiresAPictureWithEveryJobThatShowsIt)
{
    const JobRecord first = succeed("bunny"), other = succeed("teapot");
    const JobRecord twin = submit("bunny");
    const std::string picture = a_result("bunny").image_digest;
    EXPECT_EQ(store->expire_results({picture, "sha256:nobody's"}, store->newest()),
              (std::vector<std::string>{picture, "sha256:nobody's"}));
    for (const auto& id : {first.id, twin.id}) {
        EXPECT_EQ(get(id).state, StoredState::expired);
        EXPECT_FALSE(get(id).result);
        EXPECT_EQ(get(id).spec.request_json, a_request("bunny").spec.request_json) << "its scene stays";
    }
    EXPECT_EQ(get(other.id).state, StoredState::succeeded);
    EXPECT_FALSE(store->shows(picture));
    EXPECT_EQ(submit("bunny").state, StoredState::queued) << "nothing is left to share";
}

TEST_P(StoreRoom, SparesAPictureThatANewJobHasTakenSinceItWasChosen)
{
    const JobRecord first = succeed("bunny");
    const std::uint64_t chosen = store->newest();
    const JobRecord joined = submit("bunny");
    EXPECT_TRUE(store->expire_results({a_result("bunny").image_digest}, chosen).empty());
    for (const auto& id : {first.id, joined.id})
        EXPECT_EQ(get(id).result, a_result("bunny"));
}

TEST_P(StoreRoom, ForgetsWhatEndedWithoutAResultTheLongestEndedFirst)
{
    std::vector<server::JobId> ended;
    for (const char* name : {"a", "b", "c"}) {
        ended.push_back(submit(name).id);
        store->cancel("alice", ended.back(), now() + static_cast<std::int64_t>(10 - ended.size()));
    }
    const JobRecord kept = succeed("kept"), waiting = submit("waiting");
    EXPECT_EQ(store->forget_ended(2), 2U);
    EXPECT_TRUE(store->get("alice", ended[0])) << "it ended last";
    EXPECT_EQ(store->forget_ended(2), 1U);
    EXPECT_EQ(store->forget_ended(2), 0U);
    EXPECT_EQ(get(kept.id).state, StoredState::succeeded);
    EXPECT_EQ(get(waiting.id).state, StoredState::queued);
}

TEST_P(StoreRoom, TakesMoreWithEachJobAndLessWithoutIt)
{
    auto request = a_request("long");
    request.spec.request_json = std::string(1 << 20, 'x');
    const std::uint64_t before = store->stored_bytes();
    const server::JobId id = store->submit(request).job.id;
    EXPECT_GE(store->stored_bytes(), before + (1 << 20));
    store->cancel("alice", id, now());
    store->remove("alice", id);
    EXPECT_LT(store->stored_bytes(), before + (1 << 20));
}

TEST_P(StoreRoom, ReadsForAStatusNoneOfTheLongTexts)
{
    const JobRecord job = succeed("bunny");
    const JobRecord found = store->find("alice", job.id).value();
    EXPECT_EQ(found.spec.labels, a_request("bunny").spec.labels);
    EXPECT_EQ(found.result->image_digest, a_result("bunny").image_digest);
    EXPECT_EQ(found.result->samples, 64U);
    EXPECT_EQ(found.spec.request_json + found.result->report_json + found.result->scene_json, "");
    EXPECT_FALSE(store->find("bob", job.id));
    EXPECT_EQ(store->find_picture("alice", a_request("bunny").spec.render_key),
              a_result("bunny").image_digest);
    EXPECT_FALSE(store->find_picture("bob", a_request("bunny").spec.render_key));
}

TEST_P(StoreRoom, TellsAFailureInFullToWhoAsksForTheJobAndInShortInAList)
{
    const server::JobFailure why{.summary_json = "{\"short\":1}", .whole_json = "{\"long\":1}"};
    const server::JobId id = submit("broken").id;
    EXPECT_TRUE(store->fail(claim_one(), why, false, now()));
    EXPECT_EQ(get(id).failure, why);
    EXPECT_EQ(store->find("alice", id)->failure, why);
    const auto listed = store->list({.tenant = "alice"}).jobs.at(0);
    EXPECT_EQ(listed.failure.summary_json, why.summary_json);
    EXPECT_EQ(listed.failure.whole_json, "");
}

} // namespace
