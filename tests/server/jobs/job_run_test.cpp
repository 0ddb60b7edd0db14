// Jobs at and over the limits of a scene, through the whole service.
#include "tests/server/jobs/job_fixture.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace {

using api::JobState;
using tests::Node;

class JobRun : public tests::JobServiceTest {};
INSTANTIATE_TEST_SUITE_P(Every, JobRun, testing::Values("MemStore"), [](const auto& suite) {
    return std::string(suite.param);
});

// `objects` written one after the other, with commas.
std::string job_of(const std::string& objects, const std::string& more = {})
{
    return R"({"scene":{"objects":[)" + objects +
           R"(]},"image":{"width":8,"height":8},"quality":{"samples":1})" + more + "}";
}

std::string repeated(const std::string& object, std::size_t count)
{
    std::string all;
    for (std::size_t i = 0; i < count; ++i)
        all += (i == 0 ? "" : ",") + object;
    return all;
}

} // namespace

TEST_P(JobRun, RendersAsManyObjectsAsABodyOfTheLargestSizeNames)
{
    const auto node = open();
    node->jobs.start();
    const std::string body = job_of(repeated(R"({"shape":"sphere"})", 50'000));
    ASSERT_LE(body.size(), renderer::Limits{}.json_bytes);
    tests::succeeded(*node, submit(*node, body).id);
}

TEST_P(JobRun, RendersAsManyObjectsAsTheLimitAllows)
{
    renderer::Limits limits; // a body can name them, and no more of it than they need
    limits.json_bytes = 4u << 20;
    limits.json_values = 2 * limits.objects + 100;
    limits.json_depth = 8;
    const auto node = open(limits);
    node->jobs.start();
    tests::succeeded(*node, submit(*node, job_of(repeated(R"({"shape":"sphere"})", limits.objects))).id);
}

TEST_P(JobRun, ListsAThousandFaultsAndCountsTheOthers)
{
    const auto node = open();
    node->jobs.start();
    const std::string digest = tests::upload(*node, "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
    const std::string body =
        job_of(repeated(R"({"mesh":"a.obj"})", 3000), R"(,"files":{"a.obj":")" + digest + R"("})");
    const api::JobView failed = tests::finished(*node, submit(*node, body).id);
    ASSERT_EQ(failed.state, JobState::failed);
    ASSERT_TRUE(failed.error);
    ASSERT_EQ(failed.error->errors.size(), 1001U);
    EXPECT_EQ(failed.error->errors.back().code, "more_faults");
    EXPECT_NE(failed.error->errors.back().detail.find("2000 more"), std::string::npos);
    // The next such body is refused at once, with no longer a list.
    EXPECT_LE(tests::refusal(*node, {.body = body, .part_digests = {}, .idempotency_key = {}}).errors.size(),
              1001U);
}

TEST_P(JobRun, StopsImportingAtTheFirstMeshOverALimit)
{
    renderer::Limits limits;
    limits.triangles = 10;
    const auto node = open(limits);
    node->jobs.start();
    std::string objects, files;
    for (int i = 0; i < 6; ++i) { // tetrahedra, each of its own bytes
        const std::string name = "t" + std::to_string(i) + ".obj";
        const std::string digest =
            tests::upload(*node, "# " + std::to_string(i) + "\n" + tests::kTetrahedron);
        objects += (i == 0 ? "" : ",") + std::string(R"({"mesh":")") + name + R"("})";
        files += (i == 0 ? "" : ",") + std::string("\"") + name + R"(":")" + digest + "\"";
    }
    const api::JobView failed =
        tests::finished(*node, submit(*node, job_of(objects, ",\"files\":{" + files + "}")).id);
    ASSERT_EQ(failed.state, JobState::failed);
    ASSERT_TRUE(failed.error && failed.error->errors.size() == 1);
    EXPECT_EQ(failed.error->code, "over_limit");
    EXPECT_NE(failed.error->errors[0].detail.find("12 triangles"), std::string::npos);
    EXPECT_NE(failed.error->errors[0].detail.find("t2.obj"), std::string::npos);
    EXPECT_EQ(node->imports.imports_run(), 3U);
}

TEST_P(JobRun, ImportsNothingForAPictureThatDoesNotFit)
{
    renderer::Limits limits;
    limits.render_memory_bytes = 40u << 20;
    const auto node = open(limits);
    node->jobs.start();
    std::string body = tests::mesh_job(tests::upload(*node, tests::kTetrahedron));
    body.replace(body.find("\"width\":32"), 10, "\"width\":8000");
    body.replace(body.find("\"height\":24"), 11, "\"height\":4000");
    const api::JobView failed = tests::finished(*node, submit(*node, body).id);
    ASSERT_EQ(failed.state, JobState::failed);
    EXPECT_EQ(failed.error.value().code, "over_limit");
    EXPECT_EQ(node->imports.imports_run(), 0U);
}

TEST_P(JobRun, KeepsTheTreeOverTheObjectsForTheNextFrameOfAnAnimation)
{
    const auto frame = [](int number) {
        std::string objects;
        for (int i = 0; i < 300; ++i) {
            const std::string x = std::to_string(i % 20 + 0.01 * (i % 7) * number),
                              z = std::to_string(i / 20);
            objects += (i == 0 ? "" : ",") + std::string(R"({"shape":"sphere","radius":0.3,"transform":)") +
                       R"([{"translate":[)" + x + ",0," + z + "]}]}";
        }
        return job_of(objects);
    };
    constexpr int kFrames = 3;
    std::vector<std::string> pictures;
    {
        const auto node = open();
        node->jobs.start();
        for (int number = 0; number < kFrames; ++number) {
            const std::string id = tests::succeeded(*node, submit(*node, frame(number)).id).id;
            pictures.push_back(tests::digest_of_picture(*node, id));
            const auto report = nlohmann::json::parse(tests::expect<std::string>(node->jobs.report(id)));
            EXPECT_EQ(report.at("geometry").at("upper_level"), number == 0 ? "built" : "refitted");
        }
    }
    for (int number = 1; number < kFrames; ++number) {
        const auto node = open(); // which has seen no other frame
        node->jobs.start();
        const std::string id = tests::succeeded(*node, submit(*node, frame(number)).id).id;
        EXPECT_EQ(tests::digest_of_picture(*node, id), pictures[static_cast<std::size_t>(number)]);
        const auto report = nlohmann::json::parse(tests::expect<std::string>(node->jobs.report(id)));
        EXPECT_EQ(report.at("geometry").at("upper_level"), "built");
    }
}
