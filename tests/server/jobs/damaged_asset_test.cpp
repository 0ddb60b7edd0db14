// A job whose mesh the disk damaged fails with its name and the remedy; the remedy works.
#include "tests/server/jobs/job_fixture.h"

#include <fstream>

namespace {

using Kind = server::BlobStore::Kind;

using DamagedAsset = tests::JobServiceTest;
INSTANTIATE_TEST_SUITE_P(Every,
                         DamagedAsset,
                         testing::Values("MemStore", "SqliteStore"),
                         [](const auto& suite) { return std::string(suite.param); });

TEST_P(DamagedAsset, FailsTheJobAtOnceAndIsMendedByUploadingItAgain)
{
    std::string mesh;
    {
        const auto node = open();
        mesh = tests::upload(*node, tests::kTetrahedron);
        std::fstream file(node->blobs.path(Kind::asset, mesh),
                          std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(2);
        file.put('1');
    }
    const auto node = open();
    node->jobs.start();
    const api::JobView failed = tests::finished(*node, submit(*node, tests::mesh_job(mesh)).id);
    ASSERT_EQ(failed.state, api::JobState::failed);
    EXPECT_EQ(failed.attempts, 1U);
    EXPECT_EQ(failed.error->status, 422);
    ASSERT_EQ(failed.error->errors.size(), 1U);
    EXPECT_EQ(failed.error->errors[0].code, "asset_damaged");
    EXPECT_EQ(failed.error->errors[0].pointer, "/scene/objects/0/mesh");
    EXPECT_NE(failed.error->detail.find("PUT /v1/assets/" + mesh), std::string::npos) << failed.error->detail;
    // Now that it is known, it counts as missing.
    EXPECT_EQ(
        tests::refusal(*node, {.body = tests::mesh_job(mesh), .part_digests = {}, .idempotency_key = {}})
            .status,
        422);
    tests::upload(*node, tests::kTetrahedron);
    tests::succeeded(*node, submit(*node, tests::mesh_job(mesh)).id);
}

} // namespace
