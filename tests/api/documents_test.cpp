#include "api/documents.h"
#include "api/job_request.h"
#include "api/words/word_table.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <string>

namespace {

using nlohmann::json;

const std::set<std::string> kServed{"/",
                                    "/healthz",
                                    "/readyz",
                                    "/v1/version",
                                    "/v1/capabilities",
                                    "/v1/openapi.json",
                                    "/v1/assets",
                                    "/v1/assets/{digest}",
                                    "/v1/assets/{digest}/info",
                                    "/v1/jobs",
                                    "/v1/jobs/{id}",
                                    "/v1/jobs/{id}/cancel",
                                    "/v1/jobs/{id}/image",
                                    "/v1/jobs/{id}/layers/{name}",
                                    "/v1/jobs/{id}/report",
                                    "/v1/jobs/{id}/scene"};

// Every $ref and every object schema below `node`.
void walk(const json& document, const json& node, const std::string& at)
{
    if (node.is_object() && node.contains("$ref")) {
        const std::string target = node["$ref"].get<std::string>();
        ASSERT_EQ(target.substr(0, 2), "#/") << at;
        EXPECT_TRUE(document.contains(json::json_pointer(target.substr(1)))) << at << " -> " << target;
    }
    if (node.is_structured())
        for (const auto& [name, child] : node.items())
            walk(document, child, at + "/" + name);
}

TEST(Openapi, NamesExactlyThePathsThatAreServed)
{
    const json document = json::parse(api::openapi_json());
    EXPECT_EQ(document["openapi"], "3.1.0");
    std::set<std::string> paths;
    for (const auto& [path, item] : document["paths"].items())
        paths.insert(path);
    EXPECT_EQ(paths, kServed);
}

TEST(Openapi, StandsAlone)
{
    const json document = json::parse(api::openapi_json());
    walk(document, document, "");
    EXPECT_EQ(document["components"]["schemas"]["JobRequest"], json::parse(api::write_job_schema()));
    EXPECT_EQ(document["info"]["version"], json::parse(api::write_version())["version"]);
}

TEST(Openapi, DescribesEveryOperation)
{
    const json document = json::parse(api::openapi_json());
    std::set<std::string> ids;
    for (const auto& [path, item] : document["paths"].items())
        for (const auto& [method, operation] : item.items()) {
            if (method == "parameters") continue;
            EXPECT_TRUE(ids.insert(operation["operationId"].get<std::string>()).second) << path;
            EXPECT_FALSE(operation["summary"].get<std::string>().empty()) << path;
            EXPECT_TRUE(operation["responses"].contains("default")) << path;
            EXPECT_GE(operation["responses"].size(), 2u) << path;
        }
}

TEST(Openapi, LeavesNoAnswerOpenToMembersItDoesNotName)
{
    const json document = json::parse(api::openapi_json());
    for (const auto& [name, schema] : document["components"]["schemas"].items())
        if (schema.value("type", "") == "object") {
            EXPECT_TRUE(schema.contains("additionalProperties")) << name;
        }
}

TEST(Capabilities, ListEveryLimitWithItsFlag)
{
    renderer::Limits limits;
    limits.samples = 7;
    const json told = json::parse(api::write_capabilities(limits))["limits"];
    EXPECT_EQ(told.size(), renderer::limit_table().size());
    EXPECT_EQ(told["samples"]["value"], 7);
    EXPECT_EQ(told["json_bytes"]["flag"], "--limit-json-bytes");
    EXPECT_EQ(told["json_bytes"]["environment"], "HELIOGRAPH_LIMIT_JSON_BYTES");
    for (const renderer::LimitEntry& entry : renderer::limit_table())
        EXPECT_EQ(told[entry.name]["value"], limits.*entry.value) << entry.name;
}

TEST(Capabilities, ListTheWordsThatTheReaderTakes)
{
    const json told = json::parse(api::write_capabilities({}));
    const auto takes = [](const std::string& job) {
        return std::holds_alternative<api::JobRequest>(api::read_job(job, {.local = true}));
    };
    const auto object = [](const std::string& members) {
        return R"({"scene": {"objects": [{)" + members + "}]}}";
    };
    const auto scene = [](const std::string& members) {
        return R"({"scene": {"objects": [{"shape": "box"}], )" + members + "}}";
    };
    const json& models = told["models"];
    for (const json& name : models["shapes"])
        EXPECT_TRUE(takes(object(name == "mesh" ? R"("mesh": "a.obj")" : "\"shape\": " + name.dump())))
            << name;
    for (const json& name : models["materials"])
        EXPECT_TRUE(takes(scene(R"("materials": {"m": {"type": )" + name.dump() + "}}"))) << name;
    for (const json& name : models["lights"])
        EXPECT_TRUE(takes(scene(R"("lights": [{"type": )" + name.dump() + "}]"))) << name;
    for (const json& name : models["environments"]) {
        const std::string picture = name == "image" ? R"(, "image": "sky.hdr")" : "";
        EXPECT_TRUE(takes(scene(R"("environment": {"type": )" + name.dump() + picture + "}"))) << name;
    }
    for (const json& name : models["transports"])
        EXPECT_TRUE(takes(scene(R"("transport": {"type": )" + name.dump() + "}"))) << name;
    for (const json& name : models["cameras"])
        EXPECT_TRUE(takes(scene(R"("camera": {"type": )" + name.dump() + "}"))) << name;
    for (const json& name : told["formats"]["tones"])
        EXPECT_TRUE(
            takes(R"({"scene": {"objects": [{"shape": "box"}]}, "image": {"tone": )" + name.dump() + "}}"))
            << name;
    for (const json& name : told["fail_on"])
        EXPECT_TRUE(takes(R"({"scene": {"objects": [{"shape": "box"}]}, "fail_on": [)" + name.dump() + "]}"))
            << name;
    EXPECT_EQ(models["shapes"].size(), 5u);
    EXPECT_GE(models["materials"].size(), 6u);
    EXPECT_EQ(models["lights"].size(), 7u);
}

TEST(Capabilities, ShowDefaultsThatReadBack)
{
    const json defaults = json::parse(api::write_capabilities({}))["defaults"];
    const auto read = api::read_job(defaults.dump(), {.local = true});
    ASSERT_TRUE(std::holds_alternative<api::JobRequest>(read));
    EXPECT_EQ(defaults["quality"]["samples"], 64);
    EXPECT_EQ(defaults["scene"]["camera"]["fov_deg"], 45.0);
}

TEST(Version, TellsTheBuild)
{
    const json version = json::parse(api::write_version());
    for (const char* member : {"version", "commit", "compiler", "build_type", "isa"})
        EXPECT_FALSE(version[member].get<std::string>().empty()) << member;
}

} // namespace
