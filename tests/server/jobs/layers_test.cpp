// Layers outlive what their picture outlives: a restart, a lost blob, another job that shares the render.
#include "tests/server/jobs/job_fixture.h"

#include <filesystem>

namespace {

using api::JobState;
using renderer::Layer;
using tests::Node;

using JobLayers = tests::JobServiceTest;
INSTANTIATE_TEST_SUITE_P(OnDisk, JobLayers, testing::Values("SqliteStore"), [](const auto& suite) {
    return std::string(suite.param);
});

constexpr renderer::PictureEncoding kExr{renderer::PictureFormat::exr, 8};

std::string layered_job()
{
    return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":32,"height":24,"layers":["depth","albedo"]},"quality":{"samples":4}})";
}

std::string digest_of_layer(Node& node, const std::string& id, Layer layer)
{
    return tests::expect<server::EncodedPicture>(node.jobs.layer(id, layer, kExr)).digest;
}

api::ProblemDetails layer_refusal(Node& node, const std::string& id, Layer layer)
{
    const auto answer = node.jobs.layer(id, layer, kExr);
    const auto* problem = std::get_if<api::ProblemDetails>(&answer);
    EXPECT_NE(problem, nullptr);
    return problem != nullptr ? *problem : api::ProblemDetails{};
}

TEST_P(JobLayers, AreTheSameAfterARestart)
{
    std::string id, depth, albedo;
    {
        const auto node = open();
        node->jobs.start();
        id = tests::succeeded(*node, submit(*node, layered_job()).id).id;
        depth = digest_of_layer(*node, id, Layer::depth);
        albedo = digest_of_layer(*node, id, Layer::albedo);
        EXPECT_NE(depth, albedo);
        node->jobs.stop();
    }
    const auto node = open();
    EXPECT_EQ(digest_of_layer(*node, id, Layer::depth), depth);
    EXPECT_EQ(digest_of_layer(*node, id, Layer::albedo), albedo);
    EXPECT_EQ(layer_refusal(*node, id, Layer::normal).status, 404);
    EXPECT_TRUE(node->jobs.get(id)->layers.has(Layer::depth));
}

TEST_P(JobLayers, AreRenderedAgainWithTheirPicture)
{
    std::string id, depth;
    {
        const auto node = open();
        node->jobs.start();
        id = tests::succeeded(*node, submit(*node, layered_job()).id).id;
        depth = digest_of_layer(*node, id, Layer::depth);
        node->jobs.stop();
        std::filesystem::remove(
            node->blobs.path(server::BlobStore::Kind::result, tests::blob_of(*node->store, id)));
    }
    const auto node = open();
    EXPECT_EQ(layer_refusal(*node, id, Layer::depth).status, 504);
    node->jobs.start();
    tests::succeeded(*node, id);
    EXPECT_EQ(digest_of_layer(*node, id, Layer::depth), depth);
}

TEST_P(JobLayers, AreSharedByJobsThatAskForTheSameAndByNoOthers)
{
    const auto node = open();
    node->jobs.start();
    const std::string id = tests::succeeded(*node, submit(*node, layered_job()).id).id;
    const std::string same = tests::succeeded(*node, submit(*node, layered_job()).id).id;
    EXPECT_TRUE(node->jobs.get(same)->reused);
    EXPECT_EQ(digest_of_layer(*node, same, Layer::depth), digest_of_layer(*node, id, Layer::depth));
    const std::string plain = tests::succeeded(*node, submit(*node, tests::quick_job()).id).id;
    EXPECT_FALSE(node->jobs.get(plain)->reused);
    EXPECT_TRUE(tests::removed(*node, id));
    digest_of_layer(*node, same, Layer::albedo);
}

} // namespace
