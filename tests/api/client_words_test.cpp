#include "api/client_words.h"
#include "api/job_request.h"
#include "api/provenance.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using api::JobView;

JobView some_job()
{
    JobView job;
    job.id = "abc123";
    job.state = api::JobState::failed;
    job.created_ms = 1738324800123; // 2025-01-31T12:00:00.123Z
    job.started_ms = 1738324801000;
    job.finished_ms = 951782399999; // 2000-02-28T23:59:59.999Z, the day before a leap day
    job.progress = 0.375;
    job.samples_done = 24;
    job.queue_position = 0;
    job.reused = true;
    job.render_key = "sha256:" + std::string(64, 'a');
    job.priority = 70;
    job.labels = {{"batch", "seven"}, {"who", "me"}};
    job.attempts = 2;
    job.error =
        api::problem_from_faults(422, "invalid_mesh", {{"/scene/objects/0/mesh", "non_finite", "vertex 5"}});
    return job;
}

// What the one side writes, the other reads: every member comes back.
TEST(ClientWords, ReadTheJobObjectThatTheServiceWrites)
{
    const JobView job = some_job();
    const auto back = api::read_job_view(api::write_job_view(job));
    ASSERT_TRUE(back);
    EXPECT_EQ(api::write_job_view(*back), api::write_job_view(job));
    EXPECT_EQ(back->finished_ms, job.finished_ms);
    EXPECT_EQ(back->error, job.error);
}

TEST(ClientWords, ReadTheListThatTheServiceWrites)
{
    JobView other;
    other.id = "def";
    const auto page = api::read_job_list(api::write_job_list({some_job(), other}, "next"));
    ASSERT_TRUE(page);
    ASSERT_EQ(page->jobs.size(), 2u);
    EXPECT_EQ(page->jobs[1].id, "def");
    EXPECT_EQ(page->jobs[1].queue_position, std::nullopt);
    EXPECT_EQ(page->next_cursor, "next");
    EXPECT_EQ(api::read_job_list(api::write_job_list({}, ""))->next_cursor, "");
}

TEST(ClientWords, OutliveWhatTheyDoNotKnowAndRefuseWhatIsNoJob)
{
    EXPECT_TRUE(api::read_job_view(R"({"id":"a","state":"queued","novelty":{"x":[1]},"progress":"much"})"));
    for (const char* text : {"",
                             "[]",
                             "{}",
                             R"({"id":"a"})",
                             R"({"id":"a","state":"dreaming"})",
                             R"({"id":1,"state":"queued"})",
                             "{\"id\":"})
        EXPECT_FALSE(api::read_job_view(text)) << text;
    for (const char* text : {"", "{}", R"({"jobs":{}})", R"({"jobs":[{}]})"})
        EXPECT_FALSE(api::read_job_list(text)) << text;
}

TEST(ClientWords, AddToAJobAndLeaveTheRestAsItWas)
{
    const std::string job =
        R"({"scene":{"objects":[{"mesh":"a.obj"},{"mesh":"b.obj"}]},"seed":9007199254740991,"labels":{"x":"1","y":"2"}})";
    const std::string digest = "sha256:" + std::string(64, 'b');
    const std::string text = api::add_to_job(
        job, {.files = {{"a.obj", digest}, {"b.obj", digest}}, .priority = 7, .labels = {{"y", "3"}}});
    const auto read = api::read_job(text, {});
    const auto* request = std::get_if<api::JobRequest>(&read);
    ASSERT_TRUE(request) << std::get<api::ProblemDetails>(read).detail;
    EXPECT_EQ(request->scene.meshes.size(), 2u);
    EXPECT_EQ(request->scene.meshes[1].digest, digest);
    EXPECT_EQ(request->settings.seed, 9007199254740991u);
    EXPECT_EQ(request->priority, 7);
    EXPECT_EQ(request->labels, (std::map<std::string, std::string>{{"x", "1"}, {"y", "3"}}));
    EXPECT_TRUE(request->settings.image.layers.empty());
    EXPECT_THROW(api::add_to_job("no job", {}), std::invalid_argument);
}

TEST(ClientWords, AddLayersToThoseThatAJobAsksFor)
{
    for (const char* image : {R"({"layers":["normal","depth"]})", R"({"width":8})"}) {
        const std::string job =
            std::string(R"({"scene":{"objects":[{"shape":"sphere"}]},"image":)") + image + "}";
        api::JobAdditions additions;
        additions.layers.add(renderer::Layer::depth);
        additions.layers.add(renderer::Layer::normal);
        const auto read = api::read_job(api::add_to_job(job, additions), {});
        const auto* request = std::get_if<api::JobRequest>(&read);
        ASSERT_TRUE(request) << std::get<api::ProblemDetails>(read).detail;
        EXPECT_EQ(request->settings.image.layers, additions.layers);
    }
}

TEST(Provenance, NamesTheRenderAndIsLeftOutOnRequest)
{
    api::JobRequest request;
    request.settings.seed = 5;
    const auto texts = api::provenance_of(request, "sha256:00", 16);
    ASSERT_EQ(texts.size(), 2u);
    EXPECT_EQ(texts[0].keyword, "Software");
    EXPECT_EQ(texts[1].text, R"({"render_key":"sha256:00","samples":16,"seed":5})");
    request.provenance = false;
    EXPECT_TRUE(api::provenance_of(request, "sha256:00", 16).empty());
}

} // namespace
