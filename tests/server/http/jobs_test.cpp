#include "tests/server/http/live_service.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace {

using tests::bytes_of;
using tests::code_of;
using tests::fetch;
using tests::Headers;
using tests::json_of;
using tests::LiveService;
using tests::long_job;
using tests::mesh_job;
using tests::quick_job;
using tests::RawConnection;

constexpr const char* kPngMagic = "\x89PNG\r\n\x1a\n";

TEST(Jobs, AreAcceptedFollowedAndSeen)
{
    const LiveService service;
    const auto accepted = service.submit(quick_job());
    ASSERT_EQ(accepted.status, 202) << accepted.body;
    const std::string id = json_of(accepted).at("id").get<std::string>();
    EXPECT_EQ(accepted.header("location"), "/v1/jobs/" + id);
    EXPECT_EQ(accepted.header("retry-after"), "1");
    EXPECT_FALSE(accepted.has("preference-applied"));

    std::string etag;
    for (std::string state; state != "succeeded";) {
        const auto job = service.get("/v1/jobs/" + id, {{"Prefer", "wait=30"}});
        ASSERT_EQ(job.status, 200);
        EXPECT_EQ(job.header("preference-applied"), "wait=30");
        state = json_of(job).at("state").get<std::string>();
        ASSERT_TRUE(state == "queued" || state == "preparing" || state == "running" || state == "succeeded")
            << state;
        etag = job.header("etag");
    }
    EXPECT_EQ(service.get("/v1/jobs/" + id, {{"If-None-Match", etag}}).status, 304);
    const auto image = service.get("/v1/jobs/" + id + "/image");
    EXPECT_EQ(image.status, 200);
    EXPECT_EQ(image.header("content-type"), "image/png");
    EXPECT_EQ(image.body.rfind(kPngMagic, 0), 0u);
    EXPECT_EQ(service.get("/v1/jobs/" + id + "/report").status, 200);
    EXPECT_EQ(service.get("/v1/jobs/" + id + "/scene").status, 200);
}

TEST(Jobs, AskedForTheirPlanAloneAreNeitherStoredNorRendered)
{
    const LiveService service;
    const Headers is_json{{"Content-Type", "application/json"}};
    const auto plan = service.post("/v1/jobs?dry_run=true", quick_job(), is_json);
    ASSERT_EQ(plan.status, 200) << plan.body;
    const auto told = json_of(plan);
    EXPECT_FALSE(told.at("models").at("used").empty());
    EXPECT_GT(told.at("prediction").at("camera_rays").get<double>(), 0);
    EXPECT_GT(told.at("prediction").at("memory_bytes").get<double>(), 0);
    EXPECT_TRUE(json_of(service.get("/v1/jobs")).at("jobs").empty());

    EXPECT_EQ(service.post("/v1/jobs?dry_run=true", "{}", is_json).status, 422);
    EXPECT_EQ(service.post("/v1/jobs?dry_run=perhaps", quick_job(), is_json).status, 422);
    EXPECT_EQ(service.post("/v1/jobs?dry_run=false", quick_job(), is_json).status, 202);
}

TEST(Jobs, WaitedForComeFinished)
{
    const LiveService service;
    const auto done = service.submit(quick_job(), {{"Prefer", "wait=30"}});
    EXPECT_EQ(done.status, 200);
    EXPECT_EQ(done.header("preference-applied"), "wait=30");
    EXPECT_EQ(json_of(done).at("state"), "succeeded");
}

TEST(Jobs, WaitIsCutToTheLimitAndMalformedWishesAreIgnored)
{
    renderer::Limits limits;
    limits.wait_s = 7;
    const LiveService service(limits);
    EXPECT_EQ(
        service.submit(quick_job(), {{"Prefer", "wait=99999999999999999999"}}).header("preference-applied"),
        "wait=7");
    for (const char* wish : {"wait=soon", "wait", "wait=-1", ";;,"}) {
        const auto answer = service.submit(quick_job(), {{"Prefer", wish}});
        EXPECT_EQ(answer.status, 202) << wish;
        EXPECT_FALSE(answer.has("preference-applied")) << wish;
    }
}

TEST(Jobs, GiveThePictureItselfToWhoTakesNothingElse)
{
    const LiveService service;
    const auto picture = service.submit(quick_job(), {{"Prefer", "wait=30"}, {"Accept", "image/png"}});
    ASSERT_EQ(picture.status, 200) << picture.body;
    EXPECT_EQ(picture.header("content-type"), "image/png");
    EXPECT_EQ(picture.body.rfind(kPngMagic, 0), 0u);
    EXPECT_EQ(picture.header("etag"), '"' + server::digest_of(picture.body) + '"');
    EXPECT_EQ(picture.header("repr-digest").size(), 54u); // sha-256=:44 letters:
    EXPECT_EQ(picture.header("accept-ranges"), "bytes");
    EXPECT_EQ(picture.header("cache-control"), "private, immutable");
    const std::string location = picture.header("location"), id = location.substr(location.rfind('/') + 1);
    EXPECT_EQ(picture.header("content-disposition"), "inline; filename=\"" + id + ".png\"");
    EXPECT_EQ(picture.header("link"), "<" + location + "/report>; rel=\"describedby\"");
    EXPECT_NE(picture.header("server-timing").find("render;dur="), std::string::npos);

    const auto part = service.get(location + "/image", {{"Range", "bytes=0-7"}, {"Accept", "image/*"}});
    EXPECT_EQ(part.status, 206);
    EXPECT_EQ(part.body, std::string(kPngMagic, 8));
    EXPECT_EQ(service.get(location + "/image", {{"If-None-Match", picture.header("etag")}}).status, 304);
    const auto head = fetch(service.http.port(), "HEAD", location + "/image");
    EXPECT_EQ(head.header("content-length"), std::to_string(picture.body.size()));
}

TEST(Jobs, NeverGiveJsonToWhoTakesOnlyPictures)
{
    const LiveService service;
    const auto early = service.submit(long_job(), {{"Prefer", "wait=1"}, {"Accept", "image/png"}});
    EXPECT_EQ(early.status, 504);
    EXPECT_EQ(code_of(early), "still_running");
    EXPECT_NE(early.header("location"), "");
    EXPECT_NE(early.header("retry-after"), "");
    const auto at_once = service.submit(long_job(), {{"Accept", "image/png"}});
    EXPECT_EQ(at_once.status, 504);
    const auto image = service.get(early.header("location") + "/image");
    EXPECT_EQ(code_of(image), "still_running");
    EXPECT_NE(image.header("retry-after"), "");

    const auto webp = service.submit(quick_job(), {{"Accept", "image/webp"}});
    EXPECT_EQ(code_of(webp), "not_acceptable");
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats)
        EXPECT_NE(webp.body.find(entry.media_type), std::string::npos) << entry.media_type;
    EXPECT_EQ(service.get(early.header("location") + "/image", {{"Accept", "image/webp"}}).status, 406);
}

TEST(Jobs, AreReadUnderEveryTypeThatCurlMayGiveThem)
{
    const LiveService service;
    for (const char* type : {"application/json",
                             "Application/JSON; charset=utf-8",
                             "application/vnd.heliograph+json",
                             "application/x-www-form-urlencoded"}) {
        const auto answer = service.post("/v1/jobs", quick_job(), {{"Content-Type", type}});
        EXPECT_EQ(answer.status, 202) << type << answer.body;
    }
    EXPECT_EQ(service.post("/v1/jobs", quick_job()).status, 202);
    // curl -d: no line ends, and far over httplib's 8 KiB for forms.
    std::string scene = R"({"scene":{"objects":[)";
    for (int i = 0; i < 400; ++i)
        scene += std::string(i ? "," : "") + R"({"shape":"sphere","transform":[{"translate":[0,0,0]}]})";
    scene += R"(]},"image":{"width":8,"height":8},"quality":{"samples":1}})";
    ASSERT_GT(scene.size(), 16384u);
    EXPECT_EQ(service.post("/v1/jobs", scene, {{"Content-Type", "application/x-www-form-urlencoded"}}).status,
              202);
}

TEST(Jobs, OfOtherTypesAreRefusedWithTheCurlLineThatWorks)
{
    const LiveService service;
    for (const char* type :
         {"text/plain", "application/octet-stream", "model/obj", "multipart/mixed; boundary=x", "nonsense"}) {
        const auto answer = service.post("/v1/jobs", quick_job(), {{"Content-Type", type}});
        EXPECT_EQ(answer.status, 415) << type;
        EXPECT_NE(answer.body.find("curl --json"), std::string::npos) << answer.body;
    }
    const auto form =
        service.post("/v1/jobs", "scene=%7B%7D", {{"Content-Type", "application/x-www-form-urlencoded"}});
    EXPECT_EQ(code_of(form), "unsupported_media_type");
    const auto empty = service.submit("");
    EXPECT_EQ(code_of(empty), "empty_body");
    EXPECT_NE(empty.body.find("curl"), std::string::npos);
}

TEST(Jobs, AsAFormBringTheirFilesAlong)
{
    const LiveService service;
    const std::string knot = bytes_of(tests::asset_dir() + "/knot.obj");
    for (const bool scene_first : {true, false}) {
        std::vector<std::pair<std::string, std::string>> parts{{"scene", mesh_job("my knot.obj")},
                                                               {"my knot.obj", knot}};
        if (!scene_first) std::swap(parts[0], parts[1]);
        const auto [type, body] = test_support::form(parts);
        const auto answer = service.post(
            "/v1/jobs", body, {{"Content-Type", type}, {"Prefer", "wait=60"}, {"Accept", "image/png"}});
        ASSERT_EQ(answer.status, 200) << answer.body;
        EXPECT_EQ(answer.body.rfind(kPngMagic, 0), 0u);
    }
    EXPECT_TRUE(service.blobs.has(server::BlobStore::Kind::asset, server::digest_of(knot)));
}

TEST(Jobs, AsABrokenFormAreRefusedWithWhatIsWrong)
{
    renderer::Limits limits;
    limits.asset_bytes = 1000;
    limits.json_bytes = 500;
    const LiveService service(limits);
    const auto send = [&](const std::vector<std::pair<std::string, std::string>>& parts) {
        const auto [type, body] = test_support::form(parts);
        return service.post("/v1/jobs", body, {{"Content-Type", type}});
    };
    EXPECT_EQ(code_of(send({{"a.obj", "x"}})), "missing_scene");
    EXPECT_EQ(code_of(send({{"scene", quick_job()}, {"a.obj", "x"}, {"a.obj", "y"}})), "invalid_form");
    EXPECT_EQ(code_of(send({{"scene", quick_job()}, {"scene", quick_job()}})), "invalid_form");
    for (const char* name : {"", "../a.obj", "/etc/passwd", "a/../b", "a\\b", "a%0Ab", ".", "a//b"})
        EXPECT_EQ(code_of(send({{"scene", quick_job()}, {name, "x"}})), "invalid_form") << name;
    EXPECT_EQ(code_of(send({{"scene", quick_job()}, {std::string(300, 'a'), "x"}})), "invalid_form");
    EXPECT_EQ(code_of(send({{"scene", std::string(501, ' ')}})), "over_limit");
    EXPECT_EQ(
        code_of(send({{"a", std::string(600, 'x')}, {"b", std::string(600, 'y')}, {"scene", quick_job()}})),
        "over_limit");
    EXPECT_EQ(code_of(service.post("/v1/jobs", "--b", {{"Content-Type", "multipart/form-data"}})),
              "bad_request");
    EXPECT_EQ(code_of(service.post("/v1/jobs",
                                   "--b\r\nContent-Disposition: form-data; name=scene\r\n\r\n{}",
                                   {{"Content-Type", "multipart/form-data; boundary=b"}})),
              "bad_request");
    EXPECT_TRUE(service.alive());
}

TEST(Jobs, ThatFailByTheirOwnFaultAnswerTheWaitingClientWithIt)
{
    const LiveService service;
    const auto [type, body] = test_support::form(
        {{"scene", mesh_job("m.ply")}, {"m.ply", bytes_of(tests::asset_dir() + "/broken/truncated.ply")}});
    const auto fault = service.post("/v1/jobs", body, {{"Content-Type", type}, {"Prefer", "wait=60"}});
    EXPECT_EQ(fault.status, 422) << fault.body;
    EXPECT_EQ(json_of(fault).at("errors").at(0).at("pointer"), "/scene/objects/0/mesh");
    const auto picture = service.post(
        "/v1/jobs", body, {{"Content-Type", type}, {"Prefer", "wait=60"}, {"Accept", "image/png"}});
    EXPECT_EQ(picture.status, 422);
    ASSERT_NE(fault.header("location"), "");
    EXPECT_EQ(code_of(service.get(fault.header("location") + "/image")), "render_failed");
}

TEST(Jobs, TellAllFaultsAtOnceWithPointers)
{
    const LiveService service;
    const auto answer = service.submit(
        R"({"scene":{"objects":[{"shape":"spere"},{"mesh":"none.obj"}]},"image":{"widht":3},"seed":-1})");
    EXPECT_EQ(answer.status, 422);
    EXPECT_EQ(code_of(answer), "invalid_scene");
    EXPECT_GE(json_of(answer).at("errors").size(), 4u) << answer.body;
    for (const char* pointer : {"/scene/objects/0/shape", "/scene/objects/1/mesh", "/image/widht", "/seed"})
        EXPECT_NE(answer.body.find(std::string("\"") + pointer + '"'), std::string::npos)
            << pointer << answer.body;
}

TEST(Jobs, WithOneIdempotencyKeyAreOneJob)
{
    const LiveService service;
    const auto first = service.submit(quick_job(), {{"Idempotency-Key", "key-1"}});
    EXPECT_FALSE(first.has("idempotency-replayed"));
    const auto again = service.submit(quick_job(), {{"Idempotency-Key", "key-1"}});
    EXPECT_EQ(again.header("idempotency-replayed"), "true");
    EXPECT_EQ(again.header("location"), first.header("location"));
    const auto other = service.submit(quick_job(2), {{"Idempotency-Key", "key-1"}});
    EXPECT_EQ(other.status, 422);
    EXPECT_EQ(code_of(other), "idempotency_key_reuse");
    EXPECT_EQ(service.submit(quick_job(), {{"Idempotency-Key", "two words"}}).status, 400);
    EXPECT_EQ(service.submit(quick_job(), {{"Idempotency-Key", std::string(256, 'a')}}).status, 400);
}

TEST(Jobs, AreReusedUnlessAFreshRenderIsAskedFor)
{
    const LiveService service;
    const auto first = service.submit(quick_job(), {{"Prefer", "wait=30"}});
    const auto second = service.submit(quick_job(), {{"Prefer", "wait=30"}});
    EXPECT_EQ(json_of(first).at("reused"), false);
    EXPECT_EQ(json_of(second).at("reused"), true);
    EXPECT_NE(first.header("location"), second.header("location"));
    const auto fresh = service.submit(quick_job(), {{"Prefer", "wait=30"}, {"Cache-Control", "no-cache"}});
    EXPECT_EQ(json_of(fresh).at("reused"), false);
    EXPECT_EQ(fetch(service.http.port(), "DELETE", first.header("location")).status, 204);
    EXPECT_EQ(service.get(second.header("location") + "/image").status, 200);
}

TEST(Jobs, AreListedByStateAndLabelPageByPage)
{
    const LiveService service;
    for (int i = 1; i <= 5; ++i) {
        std::string job = quick_job(i);
        job.insert(1, R"("labels":{"name":")" + std::string(i % 2 ? "odd" : "even") + "\"},");
        ASSERT_EQ(service.submit(job, {{"Prefer", "wait=30"}}).status, 200);
    }
    // A result is written behind its client's back: the list by state, which is the store's, may come a
    // moment later.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    const auto succeeded = [&] { return json_of(service.get("/v1/jobs?state=succeeded")).at("jobs").size(); };
    while (succeeded() < 5 && std::chrono::steady_clock::now() < deadline)
        std::this_thread::yield();
    EXPECT_EQ(json_of(service.get("/v1/jobs")).at("jobs").size(), 5u);
    EXPECT_EQ(json_of(service.get("/v1/jobs?label=name:odd&state=succeeded")).at("jobs").size(), 3u);
    EXPECT_EQ(json_of(service.get("/v1/jobs?state=failed")).at("jobs").size(), 0u);
    std::set<std::string> seen;
    std::string target = "/v1/jobs?limit=2";
    for (int page = 0; page < 3; ++page) {
        const auto list = json_of(service.get(target));
        for (const auto& job : list.at("jobs"))
            EXPECT_TRUE(seen.insert(job.at("id").get<std::string>()).second);
        if (page < 2) target = "/v1/jobs?limit=2&cursor=" + list.at("next_cursor").get<std::string>();
    }
    EXPECT_EQ(seen.size(), 5u);
}

TEST(Jobs, ListingSaysWhatIsWrongWithItsQuery)
{
    const LiveService service;
    const auto answer = service.get("/v1/jobs?stat=failed");
    EXPECT_EQ(code_of(answer), "invalid_query");
    EXPECT_NE(answer.body.find("did you mean \\\"state\\\"?"), std::string::npos) << answer.body;
    EXPECT_NE(service.get("/v1/jobs?lable=a:b").body.find("did you mean \\\"label\\\"?"), std::string::npos);
    EXPECT_EQ(service.get("/v1/jobs?zzzzzz=1").body.find("did you mean"), std::string::npos);
    const auto all = service.get("/v1/jobs?state=runing&label=x&limit=0&cursor=%20");
    EXPECT_EQ(json_of(all).at("errors").size(), 4u) << all.body;
    EXPECT_NE(all.body.find("running"), std::string::npos);
    EXPECT_EQ(service.get("/v1/jobs?limit=1&limit=2").status, 422);
    EXPECT_EQ(service.get("/v1/jobs?cursor=not-one-of-ours").status, 422);
    EXPECT_EQ(service.post("/v1/jobs?dryrun=true", quick_job()).status, 422);
    EXPECT_EQ(service.get("/v1/version?").status, 200);
}

TEST(Jobs, AreCanceledOnceAndForAllAndForgotten)
{
    const LiveService service;
    const std::string path = service.submit(long_job()).header("location");
    EXPECT_EQ(service.post(path + "/cancel", "").status, 200);
    for (std::string state; state != "canceled";) {
        const auto job = json_of(service.get(path, {{"Prefer", "wait=30"}}));
        state = job.at("state").get<std::string>();
        ASSERT_TRUE(state == "canceling" || state == "canceled") << state;
    }
    EXPECT_EQ(json_of(service.post(path + "/cancel", "")).at("state"), "canceled");
    EXPECT_EQ(service.get(path + "/image").status, 409);
    EXPECT_EQ(fetch(service.http.port(), "DELETE", path).status, 204);
    EXPECT_EQ(fetch(service.http.port(), "DELETE", path).status, 404);
    EXPECT_EQ(service.get(path).status, 404);
    // curl -X POST without a body sends no length: nothing is missing here.
    RawConnection connection(service.http.port());
    connection.send("POST " + path + "/cancel HTTP/1.1\r\nHost: a\r\n\r\n");
    const auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 404);
}

TEST(Jobs, DeletedWhileTheyRunAreGoneAtOnce)
{
    const LiveService service;
    const std::string path = service.submit(long_job()).header("location");
    EXPECT_EQ(fetch(service.http.port(), "DELETE", path).status, 204);
    EXPECT_EQ(service.get(path).status, 404);
    EXPECT_EQ(service.submit(quick_job(), {{"Prefer", "wait=60"}}).status, 200); // the worker is free
}

TEST(Jobs, OfNoOneAreNotFound)
{
    const LiveService service;
    for (const char* id :
         {"0123456789abcdef0123456789abcdef", "x", "..%2f..", "%00", "0123456789ABCDEF0123456789ABCDEF"})
        for (const char* below : {"", "/image", "/report", "/scene"})
            EXPECT_EQ(code_of(service.get(std::string("/v1/jobs/") + id + below)), "not_found")
                << id << below;
}

} // namespace
