// All jobs together stay within limits.total_result_bytes: the results least recently used go first.
#include "tests/server/jobs/job_fixture.h"

#include <algorithm>

namespace {

using api::JobState;
using tests::Node;
using Kind = server::BlobStore::Kind;

class ResultRoom : public tests::JobServiceTest {
protected:
    static std::uint64_t used(Node& node)
    {
        return node.blobs.total_bytes(Kind::result) + node.store->stored_bytes();
    }
    // Each a picture of its own, larger than its rows.
    static std::string job(int seed)
    {
        return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":640,"height":480},"quality":{"samples":1},"seed":)" +
               std::to_string(seed) + "}";
    }
    static std::string finish(Node& node, int seed)
    {
        const std::string id = tests::succeeded(node, submit(node, job(seed)).id).id;
        return id;
    }
    // Outcomes are on disk when the service has stopped.
    std::vector<std::string> finish_all(const renderer::Limits& limits, int from, int to)
    {
        const auto node = open(limits);
        node->jobs.start();
        std::vector<std::string> ids;
        for (int seed = from; seed < to; ++seed)
            ids.push_back(finish(*node, seed));
        node->jobs.stop();
        return ids;
    }
};
INSTANTIATE_TEST_SUITE_P(OnDisk, ResultRoom, testing::Values("SqliteStore"), [](const auto& suite) {
    return std::string(suite.param);
});

TEST_P(ResultRoom, GoesToTheResultsThatWereUsedLast)
{
    const std::vector<std::string> ids = finish_all({}, 0, 12);
    renderer::Limits limits;
    {
        const auto node = open(limits);
        limits.total_result_bytes = used(*node);                                 // full to the brim
        EXPECT_EQ(tests::picture(*node, ids[0]).digest.substr(0, 7), "sha256:"); // the oldest, but used now
    }
    const auto node = open(limits);
    node->jobs.start();
    const std::string newest = finish(*node, 100);
    node->jobs.stop();
    EXPECT_LE(used(*node), limits.total_result_bytes);
    EXPECT_EQ(node->jobs.get(newest)->state, JobState::succeeded);
    EXPECT_EQ(node->jobs.get(ids[0])->state, JobState::succeeded);
    EXPECT_EQ(node->jobs.get(ids[1])->state, JobState::expired);
    EXPECT_EQ(node->jobs.get(ids.back())->state, JobState::succeeded);
    EXPECT_EQ(tests::image_refusal(*node, ids[1]).status, 410);
    tests::expect<std::string>(node->jobs.scene(ids[1])); // from which it can be sent again
}

TEST_P(ResultRoom, IsMadeAtAStartWhereThereIsMoreThanTheLimit)
{
    const std::vector<std::string> ids = finish_all({}, 0, 12);
    renderer::Limits limits;
    {
        const auto node = open();
        limits.total_result_bytes = used(*node) - node->blobs.total_bytes(Kind::result) / 2;
    }
    const auto node = open(limits);
    node->jobs.start();
    finish(*node, 100); // the keeper has swept before it stores
    node->jobs.stop();
    EXPECT_LE(used(*node), limits.total_result_bytes);
    EXPECT_EQ(node->jobs.get(ids.front())->state, JobState::expired);
    EXPECT_EQ(node->jobs.get(ids.back())->state, JobState::succeeded);
    for (const std::string& digest : node->blobs.list(Kind::result))
        EXPECT_TRUE(node->store->shows(digest)) << digest;
}

TEST_P(ResultRoom, IsRefusedWithTheNumberAndTheFlagWhereNothingIsFinished)
{
    renderer::Limits limits;
    {
        const auto node = open();
        submit(*node, tests::quick_job());
        limits.total_result_bytes = used(*node);
    }
    const auto node = open(limits); // nobody renders
    const api::ProblemDetails full =
        tests::refusal(*node, {.body = tests::quick_job("", 5), .part_digests = {}, .idempotency_key = {}});
    EXPECT_EQ(full.status, 503);
    EXPECT_EQ(full.code, "storage_full");
    EXPECT_TRUE(full.retryable);
    EXPECT_NE(full.detail.find(std::to_string(limits.total_result_bytes)), std::string::npos) << full.detail;
    EXPECT_NE(full.detail.find("--limit-total-result-bytes"), std::string::npos) << full.detail;
}

TEST_P(ResultRoom, IsLeftByJobsThatEndedWithoutAResultWhenTheirRowsAreMostOfIt)
{
    std::vector<std::string> canceled;
    renderer::Limits limits;
    {
        const auto node = open();
        for (int i = 0; i < 20; ++i) {
            std::string objects;
            for (int k = 0; k < 400; ++k)
                objects += (k ? "," : "") + std::string(R"({"shape":"sphere","radius":)") +
                           std::to_string(k + 1) + "}";
            canceled.push_back(
                submit(*node,
                       R"({"scene":{"objects":[)" + objects + R"(]},"seed":)" + std::to_string(i) + "}")
                    .id);
            node->jobs.cancel(canceled.back());
        }
        limits.total_result_bytes = used(*node);
    }
    const auto node = open(limits);
    node->jobs.start();
    const std::string id = finish(*node, 1);
    node->jobs.stop();
    EXPECT_LE(used(*node), limits.total_result_bytes);
    EXPECT_EQ(node->jobs.get(id)->state, JobState::succeeded);
    EXPECT_FALSE(node->jobs.get(canceled.front()));
}

TEST_P(ResultRoom, FailsAJobWhoseResultAloneIsOverTheLimit)
{
    renderer::Limits limits;
    {
        const auto node = open();
        limits.total_result_bytes = used(*node) + 40'000;
    }
    limits.total_result_bytes = std::max<std::uint64_t>(limits.total_result_bytes, 150'000);
    const auto node = open(limits);
    node->jobs.start();
    const std::string large =
        R"({"scene":{"objects":[{"shape":"sphere","radius":1000}],"camera":{"position":[0,0,3000],"look_at":[0,0,0]}},"image":{"width":1600,"height":1200},"quality":{"samples":1}})";
    const api::JobView failed = tests::finished(*node, submit(*node, large).id);
    ASSERT_EQ(failed.state, JobState::failed);
    EXPECT_EQ(failed.error->code, "over_limit");
    EXPECT_NE(failed.error->detail.find("--limit-total-result-bytes"), std::string::npos)
        << failed.error->detail;
}

TEST_P(ResultRoom, KeepsAnExpiredPictureForWhoJoinedWhileItWasLetGo)
{
    const std::string first = finish_all({}, 0, 1).front();
    const auto node = open();
    node->jobs.start();
    const std::uint64_t chosen = node->store->newest();
    const api::JobView joined = submit(*node, job(0));
    EXPECT_EQ(joined.state, JobState::succeeded);
    const std::string digest = tests::digest_of_picture(*node, joined.id);
    const std::string blob = tests::blob_of(*node->store, joined.id);
    EXPECT_TRUE(node->store->expire_results({blob}, chosen).empty());
    // And after it is let go for good, the same job renders again to the same bytes.
    EXPECT_EQ(node->store->expire_results({blob}, node->store->newest()).size(), 1U);
    node->blobs.remove(Kind::result, blob);
    EXPECT_EQ(tests::image_refusal(*node, first).code, "expired");
    EXPECT_EQ(tests::digest_of_picture(*node, tests::succeeded(*node, submit(*node, job(0)).id).id), digest);
}

} // namespace
