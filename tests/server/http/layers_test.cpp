// Layers beside a picture, over real sockets.
#include "tests/server/http/live_service.h"
#include "tests/support/decode_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace {

using tests::code_of;
using tests::fetch;
using tests::Headers;
using tests::HttpAnswer;
using tests::json_of;
using tests::layered_job;
using tests::LiveService;
using tests::quick_job;

const std::vector<std::string> kNames{"depth", "normal", "albedo", "samples"};

std::vector<std::uint8_t> bytes_of(const HttpAnswer& answer)
{
    return {answer.body.begin(), answer.body.end()};
}

TEST(Layers, AreLinkedAndFetchedAsThePictureIs)
{
    const LiveService service;
    const std::string id = service.finish(layered_job());
    const auto links = json_of(service.get("/v1/jobs/" + id)).at("links").at("layers");
    ASSERT_EQ(links.size(), kNames.size());
    for (const std::string& name : kNames) {
        const std::string path = links.at(name).get<std::string>();
        const HttpAnswer layer = service.get(path);
        ASSERT_EQ(layer.status, 200) << layer.body;
        EXPECT_EQ(layer.header("content-type"), "image/x-exr");
        EXPECT_EQ(layer.header("etag"), '"' + server::digest_of(layer.body) + '"');
        EXPECT_EQ(layer.header("repr-digest").size(), 54u);
        EXPECT_EQ(layer.header("accept-ranges"), "bytes");
        EXPECT_EQ(layer.header("cache-control"), "private, immutable");
        EXPECT_EQ(layer.header("vary"), "Accept");
        EXPECT_EQ(layer.header("content-disposition"), "inline; filename=\"" + id + "-" + name + ".exr\"");
        EXPECT_EQ(layer.header("link"), "</v1/jobs/" + id + "/report>; rel=\"describedby\"");
        const HttpAnswer part = service.get(path, {{"Range", "bytes=4-9"}});
        EXPECT_EQ(part.status, 206);
        EXPECT_EQ(part.body, layer.body.substr(4, 6));
        EXPECT_EQ(service.get(path, {{"If-None-Match", layer.header("etag")}}).status, 304);
        EXPECT_EQ(fetch(service.http.port(), "HEAD", path).header("content-length"),
                  std::to_string(layer.body.size()));
    }
}

TEST(Layers, HoldWhatTheCameraSees)
{
    const LiveService service;
    const std::string path = "/v1/jobs/" + service.finish(layered_job()) + "/layers/";
    const auto depth = tests::decode_exr(bytes_of(service.get(path + "depth"))).channels.at("Z");
    const auto normal = tests::decode_exr(bytes_of(service.get(path + "normal"))).channels;
    const auto albedo = tests::decode_exr(bytes_of(service.get(path + "albedo"))).channels;
    const auto samples = tests::decode_exr(bytes_of(service.get(path + "samples"))).channels.at("samples");
    ASSERT_EQ(depth.size(), 16u * 12);
    const std::size_t middle = 6 * 16 + 8;
    EXPECT_TRUE(std::isinf(depth[0]));
    EXPECT_TRUE(std::isfinite(depth[middle]));
    EXPECT_EQ(normal.at("N.Z")[0], 0);
    EXPECT_NEAR(
        std::hypot(normal.at("N.X")[middle], normal.at("N.Y")[middle], normal.at("N.Z")[middle]), 1, 0.1);
    EXPECT_EQ(albedo.at("G")[0], 0);
    EXPECT_GT(albedo.at("G")[middle], 0);
    for (const float count : samples)
        EXPECT_EQ(count, 3);
    const HttpAnswer png = service.get(path + "normal", {{"Accept", "image/png"}});
    EXPECT_EQ(png.header("content-type"), "image/png");
    EXPECT_EQ(tests::decode_8(bytes_of(png)).values[0], 128);
    EXPECT_EQ(tests::decode_16(bytes_of(service.get(path + "normal?bits=16"))).values[0], 32768);
    // The picture's own OpenEXR file has them too.
    const std::string image = path.substr(0, path.size() - 8) + "/image";
    const auto channels =
        tests::decode_exr(bytes_of(service.get(image, {{"Accept", "image/x-exr"}}))).channels;
    EXPECT_EQ(channels.size(), 11u);
    EXPECT_EQ(channels.at("Z"), depth);
    EXPECT_EQ(channels.at("albedo.G"), albedo.at("G"));
}

TEST(Layers, ThatWereNotAskedForAreNotThere)
{
    const LiveService service;
    const std::string id = service.finish(
        R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":8,"height":8,"layers":["albedo"]},"quality":{"samples":1}})");
    const HttpAnswer depth = service.get("/v1/jobs/" + id + "/layers/depth");
    EXPECT_EQ(depth.status, 404);
    EXPECT_EQ(code_of(depth), "not_found");
    EXPECT_NE(depth.body.find("for albedo"), std::string::npos) << depth.body;
    EXPECT_NE(depth.body.find("image.layers"), std::string::npos) << depth.body;
    const HttpAnswer unknown = service.get("/v1/jobs/" + id + "/layers/error");
    EXPECT_EQ(unknown.status, 404);
    EXPECT_NE(unknown.body.find("depth, normal, albedo, samples"), std::string::npos) << unknown.body;
    const std::string none = service.finish(quick_job());
    EXPECT_FALSE(json_of(service.get("/v1/jobs/" + none)).at("links").contains("layers"));
    EXPECT_NE(service.get("/v1/jobs/" + none + "/layers/depth").body.find("for none"), std::string::npos);
    EXPECT_EQ(service.get("/v1/jobs/" + std::string(32, '0') + "/layers/depth").status, 404);
}

TEST(Layers, AreRefusedInFormatsThatDoNotHoldThem)
{
    const LiveService service;
    const std::string path = "/v1/jobs/" + service.finish(layered_job()) + "/layers/";
    for (const auto& [target, accept] :
         std::vector<std::pair<std::string, std::string>>{{"depth", "image/png"},
                                                          {"samples", "image/png"},
                                                          {"normal", "image/jpeg"},
                                                          {"albedo", "image/webp"}}) {
        const HttpAnswer answer = service.get(path + target, {{"Accept", accept}});
        EXPECT_EQ(answer.status, 406) << target;
        EXPECT_NE(answer.body.find("image/x-exr"), std::string::npos) << answer.body;
    }
    EXPECT_EQ(service.get(path + "depth?bits=16").status, 406);
    EXPECT_EQ(service.get(path + "depth?bits=9").status, 422);
}

TEST(Layers, OfAJobThatIsNotFinishedAreWaitedFor)
{
    const LiveService service;
    const std::string running =
        service
            .submit(
                R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":2048,"height":2048,"layers":["depth"]},"quality":{"samples":65536}})")
            .header("location");
    EXPECT_EQ(service.get(running + "/layers/depth").status, 504);
    EXPECT_EQ(service.post(running + "/cancel", "").status, 200);
    EXPECT_EQ(service.get(running + "/layers/depth", {{"Prefer", "wait=30"}}).status, 409);
}

TEST(Layers, GoWithTheirJob)
{
    const LiveService service;
    const std::string id = service.finish(layered_job());
    ASSERT_EQ(service.get("/v1/jobs/" + id + "/layers/depth").status, 200);
    EXPECT_EQ(fetch(service.http.port(), "DELETE", "/v1/jobs/" + id).status, 204);
    EXPECT_EQ(service.get("/v1/jobs/" + id + "/layers/depth").status, 404);
    EXPECT_TRUE(service.blobs.list(server::BlobStore::Kind::result).empty());
}

} // namespace
