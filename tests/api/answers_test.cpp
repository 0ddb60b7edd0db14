// Job objects, reports and asset answers: what they say, and that they are what openapi.json promises.
#include "api/documents.h"
#include "api/job_view.h"
#include "tests/support/json_schema.h"

#include <gtest/gtest.h>

#include <limits>

namespace {

using nlohmann::json;

json checked(const std::string& text, const std::string& schema)
{
    test_support::JsonSchemas schemas;
    schemas.add("openapi.json", json::parse(api::openapi_json()));
    json value = json::parse(text);
    for (const std::string& fault : schemas.check(value, "openapi.json#/components/schemas/" + schema))
        ADD_FAILURE() << schema << " " << fault;
    return value;
}

api::JobView a_job()
{
    api::JobView view;
    view.id = std::string(32, 'a');
    view.created_ms = 1'709'164'800'250;
    view.render_key = "sha256:" + std::string(64, 'b');
    return view;
}

TEST(JobObject, TellsWhatAQueuedJobIs)
{
    api::JobView view = a_job();
    view.queue_position = 3;
    view.labels = {{"project", "atrium"}};
    const json job = checked(api::write_job_view(view), "Job");
    EXPECT_EQ(job["state"], "queued");
    EXPECT_EQ(job["created"], "2024-02-29T00:00:00.250Z");
    EXPECT_EQ(job["queue_position"], 3);
    EXPECT_EQ(job["labels"]["project"], "atrium");
    EXPECT_FALSE(job.contains("started"));
    EXPECT_FALSE(job.contains("error"));
    EXPECT_EQ(job["links"]["self"], "/v1/jobs/" + view.id);
    EXPECT_EQ(job["links"]["image"], "/v1/jobs/" + view.id + "/image");
}

TEST(JobObject, LinksTheLayersThatItWasAskedForAndNoOthers)
{
    api::JobView view = a_job();
    EXPECT_FALSE(checked(api::write_job_view(view), "Job")["links"].contains("layers"));
    view.layers.add(renderer::Layer::albedo);
    view.layers.add(renderer::Layer::depth);
    const json job = checked(api::write_job_view(view), "Job");
    EXPECT_EQ(job["links"]["layers"],
              (json{{"depth", "/v1/jobs/" + view.id + "/layers/depth"},
                    {"albedo", "/v1/jobs/" + view.id + "/layers/albedo"}}));
}

TEST(JobObject, CarriesTheFaultOfAFailedJob)
{
    api::JobView view = a_job();
    view.state = api::JobState::failed;
    view.started_ms = view.created_ms;
    view.finished_ms = view.created_ms + 1000;
    view.error = api::problem_from_faults(
        422, "invalid_mesh", {{"/scene/objects/0/mesh", "truncated", "it ends early"}});
    const json job = checked(api::write_job_view(view), "Job");
    EXPECT_EQ(job["error"]["errors"][0]["code"], "truncated");
    EXPECT_EQ(job["finished"], "2024-02-29T00:00:01.250Z");
}

TEST(JobObject, HasANameForEveryState)
{
    for (int i = 0; i < 8; ++i) {
        const auto state = static_cast<api::JobState>(i);
        EXPECT_EQ(api::job_state_from_name(api::name_of(state)), state);
        api::JobView view = a_job();
        view.state = state;
        checked(api::write_job_view(view), "Job");
    }
    EXPECT_FALSE(api::job_state_from_name("done"));
    EXPECT_TRUE(api::is_final(api::JobState::expired));
    EXPECT_FALSE(api::is_final(api::JobState::canceling));
}

TEST(JobList, SaysWhereItGoesOn)
{
    const json last = checked(api::write_job_list({a_job()}, ""), "JobList");
    EXPECT_EQ(last["jobs"].size(), 1u);
    EXPECT_FALSE(last.contains("next_cursor"));
    EXPECT_EQ(checked(api::write_job_list({}, "abc"), "JobList")["next_cursor"], "abc");

    api::JobView failed = a_job();
    failed.state = api::JobState::failed;
    failed.error = api::problem_from_faults(422, "invalid_scene", {{"/a", "x", "one"}, {"/b", "y", "two"}});
    const json error = checked(api::write_job_list({failed}, ""), "JobList")["jobs"][0]["error"];
    EXPECT_EQ(error["errors"], json::array()); // up to a thousand of them: the job itself tells
    EXPECT_EQ(error["detail"], "2 faults; first: /a: one");
}

renderer::RenderReport a_report()
{
    renderer::RenderReport report;
    report.models.used = {{"direct", "there are point lights"}};
    report.models.skipped = {{"indirect", "transport is direct"}};
    report.numerics.precision = "float";
    report.accuracy.samples = 64;
    report.threads = 2;
    report.notes = {"a.obj: 3 lines were left out"};
    return report;
}

TEST(Report, AreTheSameUnderTheNameOfAnotherJob)
{
    const std::string report = api::write_report(a_report(), "job", "key", {});
    const json other = checked(api::readdress_report(report, "other"), "Report");
    EXPECT_EQ(other["job_id"], "other");
    EXPECT_EQ(api::readdress_report(other.dump(), "job"), report);
    for (const char* none : {"", "[]", "{}", "{\"job_id\":"})
        EXPECT_THROW(api::readdress_report(none, "other"), std::invalid_argument) << none;
}

TEST(Report, TellsSamplesAskedForAndTaken)
{
    renderer::QualitySettings quality;
    quality.samples = 64;
    const json report = checked(api::write_report(a_report(), "job", "key", quality), "Report");
    EXPECT_EQ(report["accuracy"]["requested"], json({{"samples", 64}}));
    EXPECT_EQ(report["accuracy"]["samples"], 64);
    EXPECT_EQ(report["accuracy"]["met"], true);
    EXPECT_TRUE(report["accuracy"]["estimate"].is_null());
    EXPECT_EQ(report["models"]["used"][0]["name"], "direct");
    EXPECT_EQ(report["timing"]["threads"], 2);
    EXPECT_EQ(report["geometry"]["upper_level"], "none");
    EXPECT_EQ(report["notes"], json({"a.obj: 3 lines were left out"}));
}

TEST(Report, TellsWhereTheTreeOverTheObjectsIsFrom)
{
    renderer::RenderReport report = a_report();
    for (const auto& [level, word] : {std::pair{renderer::UpperLevel::none, "none"},
                                      {renderer::UpperLevel::built, "built"},
                                      {renderer::UpperLevel::refitted, "refitted"}}) {
        report.geometry.upper_level = level;
        const json told = checked(api::write_report(report, "job", "key", {}), "Report");
        EXPECT_EQ(told["geometry"]["upper_level"], word);
    }
}

TEST(Report, DoesNotClaimAMetTargetThatItCannotKnow)
{
    renderer::QualitySettings quality;
    quality.time_s = 5;
    renderer::RenderReport timed = a_report();
    timed.accuracy.stop_reason = renderer::StopReason::time;
    const json by_time = checked(api::write_report(timed, "job", "key", quality), "Report");
    EXPECT_TRUE(by_time["accuracy"]["met"].is_null());
    EXPECT_EQ(by_time["accuracy"]["stop_reason"], "time");
    quality = {};
    quality.samples = 100;
    EXPECT_EQ(checked(api::write_report(a_report(), "job", "key", quality), "Report")["accuracy"]["met"],
              false);
}

TEST(Report, StaysJsonWhereANumberIsNotFinite)
{
    renderer::RenderReport report = a_report();
    report.numerics.coordinate_ratio = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(checked(api::write_report(report, "job", "key", {}), "Report")["numerics"]["coordinate_ratio"]
                    .is_null());
}

TEST(AssetAnswer, NamesTheAsset)
{
    const std::string digest = "sha256:" + std::string(64, 'a');
    const json asset = checked(api::write_asset(digest, 12), "Asset");
    EXPECT_EQ(asset["bytes"], 12);
    EXPECT_EQ(asset["links"]["info"], "/v1/assets/" + digest + "/info");
}

TEST(AssetInfo, TellsMeshOrFault)
{
    api::AssetInfo info{"sha256:" + std::string(64, 'a'), 12, {}, {}, {}};
    checked(api::write_asset_info(info), "AssetInfo");
    info.mesh.emplace();
    info.mesh->format = "ply";
    info.mesh->triangles = 3;
    info.mesh->upper[2] = 1.5;
    const json mesh = checked(api::write_asset_info(info), "AssetInfo");
    EXPECT_EQ(mesh["mesh"]["bounds"]["upper"], json({0.0, 0.0, 1.5}));
    info.mesh.reset();
    info.fault = api::Problem{"", "no_triangles", "there are none"};
    EXPECT_EQ(checked(api::write_asset_info(info), "AssetInfo")["fault"]["code"], "no_triangles");
}

TEST(ServiceAnswers, AreWhatOpenapiPromises)
{
    checked(api::write_version(), "Version");
    checked(api::write_discovery(), "Discovery");
    checked(api::write_health(true, ""), "Health");
    checked(api::write_health(false, "draining"), "Health");
    checked(api::write_capabilities({}), "Capabilities");
    checked(api::write_capabilities(renderer::Limits::none()), "Capabilities");
    checked(api::write_problem({422, "invalid_scene", "x", false, "r", {{"/a", "wrong_type", "y"}}}),
            "Problem");
}

} // namespace
