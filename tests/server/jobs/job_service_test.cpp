// A job's life as a handler sees it, over both stores.
#include "tests/server/jobs/job_fixture.h"

#include <nlohmann/json.hpp>

#include <thread>

namespace {

using namespace std::chrono_literals;
using api::JobState;
using tests::Node;

using JobService = tests::JobServiceTest;
INSTANTIATE_TEST_SUITE_P(Every,
                         JobService,
                         testing::Values("MemStore", "SqliteStore"),
                         [](const auto& suite) { return std::string(suite.param); });

TEST_P(JobService, RendersAPicture)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView accepted = submit(*node, tests::quick_job(R"(,"labels":{"who":"me"},"priority":60)"));
    EXPECT_EQ(accepted.id.size(), 32U);
    EXPECT_TRUE(server::is_digest(accepted.render_key));
    EXPECT_FALSE(accepted.reused);
    const api::JobView done = tests::succeeded(*node, accepted.id);
    EXPECT_EQ(done.progress, 1);
    EXPECT_EQ(done.samples_done, 4U);
    EXPECT_EQ(done.attempts, 1U);
    EXPECT_EQ(done.labels.at("who"), "me");
    EXPECT_EQ(done.priority, 60);
    EXPECT_TRUE(done.started_ms && done.finished_ms && *done.started_ms <= *done.finished_ms);
    tests::digest_of_picture(*node, done.id);
    EXPECT_NE(tests::expect<std::string>(node->jobs.report(done.id)).find(done.id), std::string::npos);
    EXPECT_NE(tests::expect<std::string>(node->jobs.scene(done.id)).find("camera"), std::string::npos);
}

TEST_P(JobService, ShowsTheSameBeforeAndAfterTheResultIsStored)
{
    auto node = open();
    node->jobs.start();
    const api::JobView before = tests::succeeded(*node, submit(*node, tests::quick_job()).id);
    node->jobs.stop(); // everything is stored
    const api::JobView after = node->jobs.get(before.id).value();
    EXPECT_EQ(api::write_job_view(after), api::write_job_view(before));
}

TEST_P(JobService, TellsInItsReportWhatTheImportMissedAndLeftOut)
{
    const auto node = open();
    node->jobs.start();
    const auto report = [&](const std::string& digest) {
        const api::JobView done = tests::succeeded(*node, submit(*node, tests::mesh_job(digest)).id);
        return nlohmann::json::parse(tests::expect<std::string>(node->jobs.report(done.id)));
    };
    const std::string with_gone_mtl =
        tests::upload(*node, std::string("mtllib gone.mtl\nusemtl red\n") + tests::kTetrahedron);
    for (int i = 0; i < 2; ++i) { // the second from the cache of meshes, or as the same render
        const auto notes = report(with_gone_mtl).at("notes");
        ASSERT_EQ(notes.size(), 1U);
        EXPECT_EQ(notes[0].get<std::string>().find("mesh.obj: material file \"gone.mtl\" did not come"), 0U)
            << notes;
    }
    EXPECT_TRUE(report(tests::upload(*node, tests::kTetrahedron)).at("notes").empty());
}

TEST_P(JobService, RendersAMeshThatWasUploaded)
{
    const auto node = open();
    node->jobs.start();
    const std::string digest = tests::upload(*node, tests::kTetrahedron);
    tests::succeeded(*node, submit(*node, tests::mesh_job(digest)).id);
    EXPECT_EQ(node->imports.imports_run(), 1U);
    // The name is part of what is asked for; the mesh is known.
    tests::succeeded(*node, submit(*node, tests::mesh_job(digest), true).id);
    EXPECT_EQ(node->imports.imports_run(), 1U);
}

TEST_P(JobService, FailsAJobWhoseMeshIsBrokenAndRefusesTheNext)
{
    const auto node = open();
    node->jobs.start();
    const std::string body = tests::mesh_job(tests::upload(*node, "v 0 0 0\nv 1 0 0\nf 1 2 9\n"));
    const api::JobView failed = tests::finished(*node, submit(*node, body).id);
    ASSERT_EQ(failed.state, JobState::failed);
    ASSERT_TRUE(failed.error && !failed.error->errors.empty());
    EXPECT_EQ(failed.error->status, 422);
    EXPECT_EQ(failed.error->code, "invalid_scene");
    EXPECT_EQ(failed.error->errors.front().pointer, "/scene/objects/0/mesh");
    const api::ProblemDetails image = tests::image_refusal(*node, failed.id);
    EXPECT_EQ(image.status, 409);
    EXPECT_EQ(image.code, "render_failed");

    const api::ProblemDetails refused =
        tests::refusal(*node, {.body = body, .part_digests = {}, .idempotency_key = {}});
    EXPECT_EQ(refused.status, 422);
    EXPECT_EQ(refused.errors, failed.error->errors);
}

TEST_P(JobService, FailsAJobWithSamplesThatAreNotFiniteWhereItSaysSo)
{
    const auto node = open();
    node->jobs.start();
    // The brightest light there is, a micron away: more than a float holds.
    const std::string scene =
        R"({"scene":{"objects":[{"shape":"sphere","radius":1e-6}],)"
        R"("lights":[{"type":"point","position":[0,2e-6,0],"intensity":[1e30,1e30,1e30]}]},)"
        R"("image":{"width":32,"height":24},"quality":{"samples":2})";
    const api::JobView counted = tests::succeeded(*node, submit(*node, scene + "}").id);
    const auto report = nlohmann::json::parse(tests::expect<std::string>(node->jobs.report(counted.id)));
    EXPECT_GT(report.at("numerics").at("non_finite_samples").get<int>(), 0) << report;
    const api::JobView failed =
        tests::finished(*node, submit(*node, scene + R"(,"fail_on":["non_finite"]})").id);
    ASSERT_EQ(failed.state, JobState::failed);
    ASSERT_TRUE(failed.error);
    EXPECT_EQ(failed.error->code, "non_finite");
    EXPECT_EQ(tests::image_refusal(*node, failed.id).status, 409);
}

TEST_P(JobService, RefusesWhatCannotBeRead)
{
    const auto node = open();
    EXPECT_EQ(tests::refusal(*node, {.body = "{", .part_digests = {}, .idempotency_key = {}}).status, 400);
    const std::string unknown = "sha256:" + std::string(64, 'a');
    const auto problem =
        tests::refusal(*node, {.body = tests::mesh_job(unknown), .part_digests = {}, .idempotency_key = {}});
    EXPECT_EQ(problem.status, 422);
    ASSERT_EQ(problem.errors.size(), 1U);
    EXPECT_EQ(problem.errors.front().code, "missing_asset");
}

TEST_P(JobService, RefusesWhenTheQueueIsFull)
{
    renderer::Limits limits;
    limits.queue_jobs = 2;
    const auto node = open(limits); // no worker: nothing leaves the queue
    EXPECT_EQ(submit(*node, tests::quick_job("", 1)).queue_position, 0U);
    EXPECT_EQ(submit(*node, tests::quick_job("", 2)).queue_position, 1U);
    const auto problem =
        tests::refusal(*node, {.body = tests::quick_job("", 3), .part_digests = {}, .idempotency_key = {}});
    EXPECT_EQ(problem.status, 429);
    EXPECT_EQ(problem.code, "queue_full");
    EXPECT_TRUE(problem.retryable);
    EXPECT_GE(node->jobs.estimated_wait_s(), 1);
    EXPECT_LE(node->jobs.estimated_wait_s(), 30);
}

TEST_P(JobService, ReplaysAnIdempotencyKey)
{
    const auto node = open();
    const server::SubmitWords words{.body = tests::quick_job(), .part_digests = {}, .idempotency_key = "k1"};
    const auto first = tests::expect<server::SubmitAnswer>(node->jobs.submit(words));
    const auto second = tests::expect<server::SubmitAnswer>(node->jobs.submit(words));
    EXPECT_FALSE(first.replayed);
    EXPECT_TRUE(second.replayed);
    EXPECT_EQ(first.job.id, second.job.id);
    const auto problem =
        tests::refusal(*node, {.body = tests::quick_job("", 9), .part_digests = {}, .idempotency_key = "k1"});
    EXPECT_EQ(problem.code, "idempotency_key_reuse");
    node->jobs.start();
    tests::succeeded(*node, first.job.id);
}

TEST_P(JobService, CancelsAQueuedJobAtOnceAndStaysCanceled)
{
    const auto node = open();
    const api::JobView job = submit(*node, tests::quick_job());
    EXPECT_EQ(node->jobs.cancel(job.id)->state, JobState::canceled);
    EXPECT_EQ(node->jobs.cancel(job.id)->state, JobState::canceled);
    EXPECT_EQ(tests::image_refusal(*node, job.id).status, 409);
    EXPECT_FALSE(node->jobs.cancel(server::make_job_id()));
}

TEST_P(JobService, CancelsARunningJob)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView job = submit(*node, tests::endless_job());
    tests::running(*node, job.id);
    EXPECT_EQ(tests::image_refusal(*node, job.id).code, "still_running");
    const auto answered = node->jobs.cancel(job.id);
    EXPECT_TRUE(answered->state == JobState::canceling || answered->state == JobState::canceled);
    EXPECT_EQ(tests::finished(*node, job.id).state, JobState::canceled);
    tests::succeeded(*node, submit(*node, tests::quick_job()).id); // the worker is free
    EXPECT_EQ(node->jobs.get(job.id)->state, JobState::canceled);
}

TEST_P(JobService, TellsProgressToWhoWaitsWithAnETag)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView job = submit(*node, tests::endless_job());
    const api::JobView seen = tests::running(*node, job.id);
    const auto next = node->jobs.wait(job.id, tests::kPatience, server::etag_of(seen));
    ASSERT_TRUE(next);
    EXPECT_NE(server::etag_of(*next), server::etag_of(seen));
    EXPECT_EQ(next->state, JobState::running);
    EXPECT_GE(next->progress, seen.progress);
    // Without one, only an end counts: time runs out first.
    EXPECT_EQ(node->jobs.wait(job.id, 10ms)->state, JobState::running);
}

TEST_P(JobService, FailsAJobAtItsTimeLimit)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView failed =
        tests::finished(*node, submit(*node, tests::endless_job(R"(,"limits":{"time_s":0.05})")).id);
    ASSERT_EQ(failed.state, JobState::failed);
    EXPECT_EQ(failed.error->code, "time_limit");
}

TEST_P(JobService, ForgetsAJobAndItsPicture)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView done = tests::succeeded(*node, submit(*node, tests::quick_job()).id);
    const std::string blob = tests::blob_of(*node->store, done.id);
    EXPECT_TRUE(node->blobs.has(server::BlobStore::Kind::result, blob));
    EXPECT_TRUE(tests::removed(*node, done.id));
    EXPECT_FALSE(node->jobs.get(done.id));
    EXPECT_FALSE(node->blobs.has(server::BlobStore::Kind::result, blob));
    EXPECT_EQ(tests::image_refusal(*node, done.id).status, 404);
    EXPECT_FALSE(tests::removed(*node, done.id));
}

TEST_P(JobService, RemovesARunningJob)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView job = submit(*node, tests::endless_job());
    tests::running(*node, job.id);
    EXPECT_TRUE(tests::removed(*node, job.id));
    EXPECT_FALSE(node->jobs.get(job.id));
    const api::JobView queued = submit(*node, tests::endless_job());
    EXPECT_TRUE(tests::removed(*node, queued.id));
}

TEST_P(JobService, LetsResultsExpire)
{
    renderer::Limits limits;
    limits.retention_s = 1;
    const auto node = open(limits);
    node->jobs.start();
    const api::JobView done = tests::succeeded(*node, submit(*node, tests::quick_job()).id);
    const std::string digest = tests::digest_of_picture(*node, done.id);
    // A final job is not waited for: another one's life is the clock.
    const api::JobView clock = submit(*node, tests::endless_job(R"(,"priority":0)"));
    std::string etag = server::etag_of(clock);
    while (node->jobs.get(done.id)->state == JobState::succeeded)
        etag = server::etag_of(node->jobs.wait(clock.id, tests::kPatience, etag).value());
    EXPECT_EQ(node->jobs.get(done.id)->state, JobState::expired);
    EXPECT_EQ(tests::image_refusal(*node, done.id).status, 410);
}

TEST_P(JobService, ListsJobsWithWhatOnlyMemoryKnows)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView job = submit(*node, tests::endless_job());
    tests::running(*node, job.id);
    const std::string waiting = submit(*node, tests::quick_job()).id;
    const auto listed = [&](JobState state) {
        return tests::expect<std::string>(node->jobs.list({.state = state}));
    };
    for (const std::string& name : api::job_state_names()) {
        const JobState state = *api::job_state_from_name(name);
        EXPECT_EQ(listed(state).find(job.id) != std::string::npos, state == JobState::running) << name;
        EXPECT_EQ(listed(state).find(waiting) != std::string::npos, state == JobState::queued) << name;
    }
}

TEST_P(JobService, ListsAJobInPreparationAndOneThatIsBeingCanceledEachUnderItsState)
{
    const auto node = open(); // no worker: the test is it
    const std::string id = submit(*node, tests::quick_job()).id;
    ASSERT_EQ(node->store->claim("test", 1, std::chrono::hours(1)).size(), 1U);
    const auto is_listed = [&](JobState state) {
        return tests::expect<std::string>(node->jobs.list({.state = state})).find(id) != std::string::npos;
    };
    EXPECT_EQ(node->jobs.get(id)->state, JobState::preparing);
    EXPECT_TRUE(is_listed(JobState::preparing));
    EXPECT_FALSE(is_listed(JobState::running));
    node->jobs.cancel(id);
    EXPECT_EQ(node->jobs.get(id)->state, JobState::canceling);
    EXPECT_TRUE(is_listed(JobState::canceling));
    EXPECT_FALSE(is_listed(JobState::preparing));
}

TEST_P(JobService, RefusesJobsOnceItStopsAndAnswersWhoWaits)
{
    const auto node = open();
    node->jobs.start();
    const api::JobView job = submit(*node, tests::endless_job());
    tests::running(*node, job.id);
    std::jthread stopper([&] { node->jobs.stop(); });
    EXPECT_FALSE(api::is_final(node->jobs.wait(job.id, tests::kPatience)->state));
    stopper.join();
    EXPECT_TRUE(node->jobs.draining());
    EXPECT_EQ(node->jobs.get(job.id)->state, JobState::queued);
    EXPECT_EQ(node->jobs.get(job.id)->attempts, 0U);
    const auto problem =
        tests::refusal(*node, {.body = tests::quick_job(), .part_digests = {}, .idempotency_key = {}});
    EXPECT_EQ(problem.status, 503);
    EXPECT_EQ(problem.code, "draining");
}

} // namespace
