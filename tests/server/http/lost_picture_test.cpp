#include "tests/server/http/live_service.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace {

using tests::code_of;
using tests::fetch;
using tests::json_of;
using tests::LiveService;

TEST(LostPicture, IsAnsweredWithRetryAfterUntilItIsRenderedAgain)
{
    LiveService service;
    const std::string job = "/v1/jobs/" + service.finish(tests::quick_job());
    const auto picture = service.get(job + "/image");
    ASSERT_EQ(picture.status, 200);
    service.jobs.stop(); // its memory has the picture still; another service's has not

    server::JobService next(*service.store, service.blobs, service.imports, {{}, 1, service.log});
    server::HttpOptions options;
    options.port = 0;
    server::HttpServer http(next, *service.store, service.blobs, service.imports, service.log, options);
    http.start();
    const std::string blob = service.store->find({}, job.substr(job.rfind('/') + 1))->result->image_digest;
    std::filesystem::resize_file(service.blobs.path(server::BlobStore::Kind::result, blob), 20);
    EXPECT_EQ(json_of(fetch(http.port(), "GET", job)).at("state"), "succeeded");
    const auto lost = fetch(http.port(), "GET", job + "/image");
    EXPECT_EQ(lost.status, 504);
    EXPECT_EQ(code_of(lost), "still_running");
    EXPECT_EQ(lost.header("retry-after"), "1");
    EXPECT_EQ(json_of(fetch(http.port(), "GET", job)).at("state"), "queued");
    EXPECT_EQ(code_of(fetch(http.port(), "GET", job + "/report")), "still_running");

    next.start();
    const auto again = fetch(http.port(), "GET", job + "/image", {{"Prefer", "wait=60"}});
    EXPECT_EQ(again.status, 200);
    EXPECT_EQ(again.header("etag"), picture.header("etag"));
    EXPECT_TRUE(again.body == picture.body);
    EXPECT_EQ(json_of(fetch(http.port(), "GET", job)).at("state"), "succeeded");
}

} // namespace
