#include "tests/server/http/live_service.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <thread>

namespace {

using tests::code_of;
using tests::fetch;
using tests::json_of;
using tests::LiveService;
using tests::quick_job;

// One film, whatever is asked for first: each format has its own bytes, tag, digest and name.
TEST(Jobs, GiveEveryFormatUnderATagOfItsOwn)
{
    const LiveService service;
    const std::string job = "/v1/jobs/" + service.finish(quick_job()), image = job + "/image";
    std::set<std::string> etags{service.get(image).header("etag")};
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats) {
        const bool deep = entry.format == renderer::PictureFormat::png;
        const std::string target = image + (deep ? "?bits=16" : ""), type(entry.media_type);
        const auto picture = service.get(target, {{"Accept", type}});
        ASSERT_EQ(picture.status, 200) << type << picture.body;
        EXPECT_EQ(picture.header("content-type"), type);
        EXPECT_EQ(picture.header("vary"), "Accept");
        EXPECT_EQ(picture.header("etag"), '"' + server::digest_of(picture.body) + '"');
        EXPECT_TRUE(etags.insert(picture.header("etag")).second) << type;
        const std::string name = job.substr(9) + std::string(entry.extension);
        EXPECT_EQ(picture.header("content-disposition"), "inline; filename=\"" + name + '"');
        const auto part = service.get(target, {{"Accept", type}, {"Range", "bytes=1-4"}});
        EXPECT_EQ(part.status, 206);
        EXPECT_EQ(part.body, picture.body.substr(1, 4));
        const auto known = service.get(target, {{"Accept", type}, {"If-None-Match", picture.header("etag")}});
        EXPECT_EQ(known.status, 304);
        const auto head = fetch(service.http.port(), "HEAD", target, {{"Accept", type}});
        EXPECT_EQ(head.header("content-length"), std::to_string(picture.body.size())) << type;
        EXPECT_EQ(head.header("etag"), picture.header("etag"));
    }
    const auto waited = service.submit(quick_job(), {{"Prefer", "wait=30"}, {"Accept", "image/x-exr"}});
    EXPECT_EQ(waited.body.substr(0, 4), "\x76\x2f\x31\x01");
    EXPECT_TRUE(etags.contains(waited.header("etag"))) << "the same bytes as GET";
}

TEST(Jobs, GiveSixteenBitsOfPngAlone)
{
    const LiveService service;
    const std::string image = "/v1/jobs/" + service.finish(quick_job()) + "/image";
    EXPECT_EQ(service.get(image + "?bits=16").body[24], 16);
    EXPECT_EQ(service.get(image + "?bits=8").body[24], 8);
    EXPECT_EQ(service.get(image + "?bits=16", {{"Accept", "image/jpeg, image/png;q=0.1"}}).body[24], 16);
    EXPECT_EQ(service.get(image + "?bits=16", {{"Accept", "image/jpeg"}}).status, 406);
    for (const char* bits : {"", "0", "9", "32", "x"})
        EXPECT_EQ(service.get(image + "?bits=" + bits).status, 422) << bits;
}

// Of what encodes: the PNG of 8 bits is there already.
TEST(Jobs, EncodeForNoMoreThanMayWait)
{
    renderer::Limits limits;
    limits.waiters = 0;
    const LiveService service(limits);
    const std::string job = service.submit(quick_job()).header("location"), image = job + "/image";
    while (json_of(service.get(job)).at("state") != "succeeded")
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(service.get(image).status, 200);
    const auto busy = service.get(image, {{"Accept", "image/x-exr"}});
    EXPECT_EQ(busy.status, 429);
    EXPECT_EQ(code_of(busy), "too_many_waiters");
}

TEST(Jobs, GiveThePictureInTheFormatsThatCapabilitiesNameAndInNoOther)
{
    const LiveService service;
    const std::string image = "/v1/jobs/" + service.finish(tests::quick_job()) + "/image";
    const auto named = json_of(service.get("/v1/capabilities")).at("formats").at("images");
    ASSERT_FALSE(named.empty());
    for (const char* type : {"image/png",
                             "image/jpeg",
                             "image/vnd.radiance",
                             "image/x-exr",
                             "image/x-portable-floatmap",
                             "image/webp"}) {
        const bool built = std::find(named.begin(), named.end(), type) != named.end();
        const auto answer = service.get(image, {{"Accept", type}});
        EXPECT_EQ(answer.status, built ? 200 : 406) << type;
        EXPECT_EQ(answer.header("content-type"), built ? type : std::string("application/problem+json"));
    }
    for (const auto& type : named) // none that this test does not know
        EXPECT_EQ(service.get(image, {{"Accept", type.get<std::string>()}}).header("content-type"), type);
}

} // namespace
