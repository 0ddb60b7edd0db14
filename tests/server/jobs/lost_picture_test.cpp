// A job that succeeded and whose picture the disk lost: it says so, and renders again.
#include "tests/server/jobs/job_fixture.h"

#include <fstream>
#include <functional>

namespace {

using api::JobState;
using tests::Node;
using Kind = server::BlobStore::Kind;

using LostPicture = tests::JobServiceTest;
INSTANTIATE_TEST_SUITE_P(OnDisk, LostPicture, testing::Values("SqliteStore"), [](const auto& suite) {
    return std::string(suite.param);
});

using Damage = std::function<void(const std::filesystem::path&)>;

void flip_a_byte(const std::filesystem::path& file)
{
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(100);
    const char was = static_cast<char>(stream.get());
    stream.seekp(100);
    stream.put(static_cast<char>(was ^ 1));
}

const std::vector<Damage>& damages()
{
    static const std::vector<Damage> all{
        flip_a_byte,
        [](const auto& file) { std::filesystem::resize_file(file, 100); },
        [](const auto& file) { std::filesystem::resize_file(file, 0); }, // as a power cut leaves it
        [](const auto& file) { std::filesystem::remove(file); },
    };
    return all;
}

struct Kept {
    std::string id, digest, blob;
    std::filesystem::path file;
};

// Rendered and on disk.
Kept keep(Node& node, const std::string& body)
{
    node.jobs.start();
    const std::string id = tests::succeeded(node, submit(node, body).id).id;
    const std::string digest = tests::digest_of_picture(node, id);
    node.jobs.stop();
    const std::string blob = tests::blob_of(*node.store, id);
    return {id, digest, blob, node.blobs.path(Kind::result, blob)};
}

void expect_again(Node& node, const std::string& id)
{
    const api::ProblemDetails lost = tests::image_refusal(node, id);
    EXPECT_EQ(lost.status, 504);
    EXPECT_EQ(lost.code, "still_running");
    EXPECT_TRUE(lost.retryable);
    EXPECT_NE(lost.detail.find("lost"), std::string::npos) << lost.detail;
}

TEST_P(LostPicture, IsRenderedAgainAfterARestart)
{
    for (std::size_t i = 0; i < damages().size(); ++i) {
        const Kept kept = keep(*open(), tests::quick_job("", 4 + static_cast<int>(i)));
        damages()[i](kept.file);
        const auto node = open();
        EXPECT_EQ(node->jobs.get(kept.id)->state, JobState::succeeded) << "nobody knows yet";
        expect_again(*node, kept.id);
        const api::JobView waiting = node->jobs.get(kept.id).value();
        EXPECT_EQ(waiting.state, JobState::queued);
        EXPECT_EQ(waiting.queue_position, 0U);
        EXPECT_FALSE(waiting.finished_ms);
        EXPECT_EQ(waiting.progress, 0);
        EXPECT_EQ(tests::image_refusal(*node, kept.id).code, "still_running");
        node->jobs.start();
        tests::succeeded(*node, kept.id);
        EXPECT_EQ(tests::digest_of_picture(*node, kept.id), kept.digest);
        tests::expect<std::string>(node->jobs.report(kept.id));
        node->jobs.stop();
        EXPECT_TRUE(open()->blobs.read(Kind::result, kept.blob));
    }
}

TEST_P(LostPicture, IsRenderedAgainByTheServiceThatIsRunning)
{
    for (std::size_t i = 0; i < damages().size(); ++i) {
        const Kept kept = keep(*open(), tests::quick_job("", 4 + static_cast<int>(i)));
        const auto node = open();
        node->jobs.start();
        damages()[i](kept.file);
        expect_again(*node, kept.id);
        tests::succeeded(*node, kept.id);
        EXPECT_EQ(tests::digest_of_picture(*node, kept.id), kept.digest);
    }
}

TEST_P(LostPicture, IsServedWhileMemoryHasIt)
{
    const auto node = open();
    node->jobs.start();
    const std::string id = tests::succeeded(*node, submit(*node, tests::quick_job()).id).id;
    const std::string digest = tests::digest_of_picture(*node, id);
    std::filesystem::remove(node->blobs.path(Kind::result, tests::blob_of(*node->store, id)));
    EXPECT_EQ(tests::digest_of_picture(*node, id), digest);
}

TEST_P(LostPicture, IsNotOneThatCannotBeReadJustNow)
{
    const Kept kept = keep(*open(), tests::quick_job());
    const auto node = open();
    const std::filesystem::path aside = kept.file.string() + "-aside";
    std::filesystem::rename(kept.file, aside);
    std::filesystem::create_symlink(aside, kept.file); // links are not followed
    EXPECT_THROW(node->jobs.image(kept.id), server::StoreError);
    EXPECT_EQ(node->jobs.get(kept.id)->state, JobState::succeeded);
    std::filesystem::rename(aside, kept.file);
    EXPECT_EQ(tests::digest_of_picture(*node, kept.id), kept.digest);
}

TEST_P(LostPicture, IsRenderedOnceForAllWhoSharedIt)
{
    std::string twin;
    Kept kept;
    {
        const auto node = open();
        node->jobs.start();
        kept.id = tests::succeeded(*node, submit(*node, tests::quick_job()).id).id;
        twin = tests::succeeded(*node, submit(*node, tests::quick_job()).id).id;
        kept.digest = tests::digest_of_picture(*node, kept.id);
        node->jobs.stop();
        flip_a_byte(node->blobs.path(Kind::result, tests::blob_of(*node->store, kept.id)));
    }
    const auto node = open();
    expect_again(*node, kept.id);
    expect_again(*node, twin);
    const std::string third = submit(*node, tests::quick_job()).id; // takes nothing that is lost
    EXPECT_EQ(node->jobs.get(third)->state, JobState::queued);
    node->jobs.start();
    int reused = 0;
    for (const std::string& id : {kept.id, twin, third}) {
        reused += tests::succeeded(*node, id).reused ? 1 : 0;
        EXPECT_EQ(tests::digest_of_picture(*node, id), kept.digest);
    }
    EXPECT_EQ(reused, 2);
}

TEST_P(LostPicture, IsNamedWithTheMeshThatIsGoneToo)
{
    Kept kept;
    std::string mesh;
    {
        const auto node = open();
        mesh = tests::upload(*node, tests::kTetrahedron);
        kept = keep(*node, tests::mesh_job(mesh));
        node->blobs.remove(Kind::asset, mesh);
    }
    flip_a_byte(kept.file);
    const auto node = open();
    const api::ProblemDetails lost = tests::image_refusal(*node, kept.id);
    EXPECT_EQ(lost.status, 500);
    EXPECT_EQ(lost.code, "result_damaged");
    EXPECT_NE(lost.detail.find(mesh), std::string::npos) << lost.detail;
    EXPECT_EQ(node->jobs.get(kept.id)->state, JobState::succeeded);
    tests::expect<std::string>(node->jobs.report(kept.id)); // it is still right

    tests::upload(*node, tests::kTetrahedron);
    expect_again(*node, kept.id);
    node->jobs.start();
    tests::succeeded(*node, kept.id);
    EXPECT_EQ(tests::digest_of_picture(*node, kept.id), kept.digest);
}

} // namespace
