// openapi.json and the server are held against each other: the same routes, and every answer of a walk over
// all of them has a status, headers, type and shape that the document knows.
#include "tests/server/http/live_service.h"
#include "tests/support/places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using tests::Headers;
using tests::HttpAnswer;
using tests::LiveService;

const std::set<std::string> kMethods{"get", "head", "post", "put", "patch", "delete", "options"};
const std::string kNoDigest = "sha256:" + std::string(64, '0');
const std::string kNoJob(32, '0');

std::string lower(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return text;
}

class OpenApi : public testing::Test {
protected:
    void SetUp() override
    {
        document = json::parse(service.get("/v1/openapi.json").body);
        schemas.add("openapi.json", document);
        digest = tests::json_of(service.post("/v1/assets", tests::bytes_of(tests::asset_dir() + "/knot.ply")))
                     .at("digest")
                     .get<std::string>();
        done = service.finish(tests::layered_job());
    }

    const json& followed(const json& node) const
    {
        return node.contains("$ref")
                   ? document.at(json::json_pointer(node["$ref"].get<std::string>().substr(1)))
                   : node;
    }

    // Those that depend on the request may be absent; what is there has its shape.
    void expect_headers(const json& headers, const HttpAnswer& answer) const
    {
        static const std::set<std::string> sometimes{
            "Preference-Applied", "Idempotency-Replayed", "Server-Timing", "Location"};
        for (const auto& [name, header] : headers.items()) {
            if (!answer.has(lower(name))) {
                EXPECT_TRUE(sometimes.contains(name)) << "lacks " << name;
                continue;
            }
            const json& schema = followed(header).at("schema");
            for (const std::string& fault : schemas.check(answer.header(lower(name)), schema, "openapi.json"))
                ADD_FAILURE() << name << fault;
        }
    }

    // What the document says of such an answer.
    void expect_documented(const std::string& path, const std::string& method, const HttpAnswer& answer)
    {
        SCOPED_TRACE(method + " " + path + " -> " + std::to_string(answer.status) + " " +
                     answer.body.substr(0, 300));
        const json& responses = document.at("paths").at(path).at(lower(method)).at("responses");
        const std::string status = std::to_string(answer.status);
        ASSERT_TRUE(responses.contains(status) || answer.status == 404 || answer.status == 422 ||
                    answer.status == 405)
            << "status is not documented";
        const json& response = followed(responses.at(responses.contains(status) ? status : "default"));
        expect_headers(response.value("headers", json::object()), answer);
        if (!response.contains("content") || method == "HEAD") {
            EXPECT_EQ(answer.body, "");
            return;
        }
        const std::string type =
            answer.header("content-type").substr(0, answer.header("content-type").find(';'));
        ASSERT_TRUE(response["content"].contains(type)) << type << " is not documented";
        if (type != "application/json" && type != "application/problem+json") return;
        for (const std::string& fault :
             schemas.check(json::parse(answer.body), response["content"][type].at("schema"), "openapi.json"))
            ADD_FAILURE() << fault;
    }

    HttpAnswer ask(const std::string& path,
                   const std::string& method,
                   const std::string& target,
                   const Headers& headers = {},
                   const std::string& body = {})
    {
        const HttpAnswer answer = tests::fetch(service.http.port(), method, target, headers, body);
        expect_documented(path, method, answer);
        return answer;
    }

    std::string filled(std::string path, const std::string& id, const std::string& asset) const
    {
        for (const auto& [name, value] :
             std::map<std::string, std::string>{{"{id}", id}, {"{digest}", asset}, {"{name}", "normal"}})
            if (const std::size_t at = path.find(name); at != std::string::npos)
                path.replace(at, name.size(), value);
        return path;
    }

    const LiveService service;
    json document;
    test_support::JsonSchemas schemas;
    std::string digest, done;
};

TEST_F(OpenApi, NamesTheRoutesOfTheServerAndNoOthers)
{
    std::set<std::string> documented, served;
    for (const auto& [path, operations] : document.at("paths").items())
        for (const auto& [method, operation] : operations.items())
            if (kMethods.contains(method) && method != "head") { // every GET answers HEAD
                std::string upper = method;
                std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) {
                    return static_cast<char>(std::toupper(c));
                });
                documented.insert(upper + " " + path);
            }
    for (const std::string& route : service.http.routes())
        served.insert(route);
    EXPECT_EQ(documented, served);
}

TEST_F(OpenApi, DescribesWhatEveryGetAnswers)
{
    for (const auto& [path, operations] : document.at("paths").items()) {
        if (!operations.contains("get")) continue;
        EXPECT_EQ(ask(path, "GET", filled(path, done, digest)).status, 200) << path;
        if (operations.contains("head")) ask(path, "HEAD", filled(path, done, digest));
        EXPECT_EQ(ask(path, "GET", filled(path, done, digest) + "?no_such_key=1").status, 422) << path;
        if (path.find('{') != std::string::npos) {
            EXPECT_EQ(ask(path, "GET", filled(path, kNoJob, kNoDigest)).status, 404) << path;
        }
    }
}

TEST_F(OpenApi, DescribesConditionsRangesAndPicturesNotYetThere)
{
    const std::string image = "/v1/jobs/{id}/image", layer = "/v1/jobs/{id}/layers/{name}",
                      asset = "/v1/assets/{digest}";
    for (const auto& [path, target] :
         std::map<std::string, std::string>{{image, filled(image, done, "")},
                                            {layer, filled(layer, done, "")},
                                            {asset, filled(asset, "", digest)}}) {
        const std::string etag = service.get(target).header("etag");
        EXPECT_EQ(ask(path, "GET", target, {{"Range", "bytes=0-3"}}).status, 206);
        EXPECT_EQ(ask(path, "GET", target, {{"Range", "bytes=99999999-"}}).status, 416);
        EXPECT_EQ(ask(path, "GET", target, {{"If-None-Match", etag}}).status, 304);
    }
    const std::string job = filled("/v1/jobs/{id}", done, "");
    EXPECT_EQ(ask("/v1/jobs/{id}", "GET", job, {{"If-None-Match", service.get(job).header("etag")}}).status,
              304);
    EXPECT_EQ(ask(image, "GET", filled(image, done, ""), {{"Accept", "image/webp"}}).status, 406);
    for (const char* type : {"image/jpeg", "image/vnd.radiance", "image/x-exr", "image/x-portable-floatmap"})
        EXPECT_EQ(ask(image, "GET", filled(image, done, ""), {{"Accept", type}}).status, 200) << type;
    EXPECT_EQ(ask(image, "GET", filled(image, done, "") + "?bits=16").status, 200);
    EXPECT_EQ(ask(image, "GET", filled(image, done, "") + "?bits=12").status, 422);
    for (const char* type : {"image/png", "image/x-exr", "image/x-portable-floatmap"})
        EXPECT_EQ(ask(layer, "GET", filled(layer, done, ""), {{"Accept", type}}).status, 200) << type;
    EXPECT_EQ(ask(layer, "GET", filled(layer, done, ""), {{"Accept", "image/jpeg"}}).status, 406);
    EXPECT_EQ(ask(layer, "GET", filled(layer, done, "") + "?bits=16").status, 200);
    EXPECT_EQ(ask(layer, "GET", filled("/v1/jobs/{id}/layers/error", done, "")).status, 404);
    EXPECT_EQ(
        ask("/v1/jobs/{id}", "GET", filled("/v1/jobs/{id}", service.finish(tests::quick_job()), "")).status,
        200); // without layers
    const std::string running = service.submit(tests::long_job()).header("location");
    EXPECT_EQ(ask("/v1/jobs/{id}", "GET", running).status, 200);
    EXPECT_EQ(ask(image, "GET", running + "/image").status, 504);
    EXPECT_EQ(ask("/v1/jobs/{id}/report", "GET", running + "/report").status, 504);
    EXPECT_EQ(ask("/v1/jobs/{id}/scene", "GET", running + "/scene").status, 200);
    EXPECT_EQ(ask("/v1/jobs/{id}/cancel", "POST", running + "/cancel").status, 200);
    EXPECT_EQ(ask("/v1/jobs/{id}/cancel", "POST", filled("/v1/jobs/{id}/cancel", kNoJob, "")).status, 404);
    service.get(running, {{"Prefer", "wait=30"}});
    EXPECT_EQ(ask(image, "GET", running + "/image", {{"Prefer", "wait=30"}}).status, 409);
    EXPECT_EQ(ask("/v1/jobs/{id}/report", "GET", running + "/report").status, 409);
    EXPECT_EQ(ask("/v1/jobs/{id}", "DELETE", running).status, 204);
    EXPECT_EQ(ask("/v1/jobs/{id}", "DELETE", running).status, 404);
}

TEST_F(OpenApi, DescribesWhatUploadsAnswer)
{
    const std::string put = "/v1/assets/{digest}", post = "/v1/assets", bytes = "any bytes";
    EXPECT_EQ(ask(post, "POST", post, {}, bytes).status, 201);
    EXPECT_EQ(ask(post, "POST", post, {}, bytes).status, 200);
    EXPECT_EQ(ask(post, "POST", post).status, 422);
    EXPECT_EQ(ask(put, "PUT", "/v1/assets/" + server::digest_of(bytes), {}, bytes).status, 200);
    EXPECT_EQ(ask(put, "PUT", "/v1/assets/" + server::digest_of("others"), {}, "others").status, 201);
    EXPECT_EQ(ask(put, "PUT", "/v1/assets/" + kNoDigest, {}, bytes).status, 422);
    EXPECT_EQ(ask(post, "POST", post, {{"Content-Type", "multipart/form-data; boundary=b"}}, bytes).status,
              415);
    EXPECT_EQ(ask(post + "/{digest}/info", "GET", post + "/" + server::digest_of(bytes) + "/info").status,
              200); // no mesh: a fault
}

TEST_F(OpenApi, DescribesWhatSubmissionsAnswer)
{
    const std::string jobs = "/v1/jobs";
    const auto submit = [&](const std::string& body, Headers headers = {}) {
        headers.insert(headers.begin(), {"Content-Type", "application/json"});
        return ask(jobs, "POST", jobs, headers, body).status;
    };
    EXPECT_EQ(
        ask(jobs, "POST", jobs + "?dry_run=true", {{"Content-Type", "application/json"}}, tests::quick_job())
            .status,
        200);
    EXPECT_EQ(submit(tests::quick_job(7)), 202);
    EXPECT_EQ(submit(tests::quick_job(7), {{"Prefer", "wait=30"}}), 200);
    EXPECT_EQ(submit(tests::quick_job(7), {{"Prefer", "wait=30"}, {"Accept", "image/png"}}), 200);
    EXPECT_EQ(submit(tests::quick_job(7), {{"Prefer", "wait=30"}, {"Accept", "image/x-exr"}}), 200);
    EXPECT_EQ(submit(tests::quick_job(7), {{"Accept", "image/webp"}}), 406);
    EXPECT_EQ(submit("{", {}), 400);
    EXPECT_EQ(submit("{}", {}), 422);
    EXPECT_EQ(submit(std::string(2u << 20, ' '), {}), 413);
    EXPECT_EQ(ask(jobs, "POST", jobs, {{"Content-Type", "text/plain"}}, "hello").status, 415);
    EXPECT_EQ(submit(tests::quick_job(8), {{"Idempotency-Key", "k"}}), 202);
    EXPECT_EQ(submit(tests::quick_job(9), {{"Idempotency-Key", "k"}}), 422);
    EXPECT_EQ(submit(tests::long_job(), {{"Accept", "image/png"}}), 504);
    EXPECT_EQ(ask(jobs, "GET", "/v1/jobs?limit=2").status, 200);
    EXPECT_EQ(ask(jobs, "GET", "/v1/jobs?state=succeeded&label=a:b").status, 200);
}

} // namespace
