// LiveService: the whole service behind real sockets, in this process, with its jobs in memory and a folder
// of its own.
#pragma once

#include "server/http/http_server.h"
#include "server/import/import_service.h"
#include "server/jobs/job_service.h"
#include "server/log/log.h"
#include "server/store/blob_store.h"
#include "server/store/mem_store.h"
#include "tests/support/json_schema.h"
#include "tests/support/places.h"
#include "tests/support/raw_http.h"
#include "tests/support/temp_folder.h"

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <utility>

namespace tests {

using test_support::fetch;
using test_support::Headers;
using test_support::HttpAnswer;
using test_support::RawConnection;

class LiveService {
public:
    explicit LiveService(const renderer::Limits& limits = {},
                         const std::string& importer = tests::bin_dir() + "/heliograph-import",
                         std::unique_ptr<server::Store> jobs_kept = server::make_mem_store())
        : store(std::move(jobs_kept)), blobs(folder.path() / "blobs"), imports(importer, blobs, limits, log),
          jobs(*store, blobs, imports, {limits, 1, log}),
          http(jobs, *store, blobs, imports, log, options(limits))
    {
        jobs.start();
        http.start();
    }
    ~LiveService()
    {
        jobs.stop();
        http.stop();
    }
    LiveService(const LiveService&) = delete;
    LiveService& operator=(const LiveService&) = delete;

    HttpAnswer get(const std::string& target, const Headers& headers = {}) const
    {
        return fetch(http.port(), "GET", target, headers);
    }
    HttpAnswer post(const std::string& target, const std::string& body, Headers headers = {}) const
    {
        return fetch(http.port(), "POST", target, headers, body);
    }
    HttpAnswer submit(const std::string& json, Headers headers = {}) const
    {
        headers.emplace_back("Content-Type", "application/json");
        return fetch(http.port(), "POST", "/v1/jobs", headers, json);
    }
    // Submits, waits for the end and gives the job's id.
    std::string finish(const std::string& json) const
    {
        return nlohmann::json::parse(submit(json, {{"Prefer", "wait=60"}}).body).at("id").get<std::string>();
    }
    bool alive() const { return get("/healthz").status == 200; }

    tests::TempFolder folder;
    server::Log log{server::LogLevel::error};
    std::unique_ptr<server::Store> store;
    server::BlobStore blobs;
    server::ImportService imports;
    server::JobService jobs;
    server::HttpServer http;

private:
    static server::HttpOptions options(const renderer::Limits& limits)
    {
        server::HttpOptions wanted;
        wanted.port = 0;
        wanted.health_port = 0;
        wanted.limits = limits;
        return wanted;
    }
};

// Rendered in a moment; `seed` makes it another job.
inline std::string quick_job(int seed = 1)
{
    return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":16,"height":12},"quality":{"samples":1},"seed":)" +
           std::to_string(seed) + "}";
}

// Quick, with every layer: a ball that leaves part of the picture empty.
inline std::string layered_job(int seed = 1)
{
    return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":16,"height":12,"layers":["depth","normal","albedo","samples"]},"quality":{"samples":3},"seed":)" +
           std::to_string(seed) + "}";
}

// Not finished before the test is.
inline std::string long_job(int seed = 1)
{
    return R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":2048,"height":2048},"quality":{"samples":65536},"seed":)" +
           std::to_string(seed) + "}";
}

inline std::string mesh_job(const std::string& name)
{
    return R"({"scene":{"objects":[{"mesh":")" + name +
           R"("}]},"image":{"width":16,"height":12},"quality":{"samples":1}})";
}

// The member `code` of a problem; a sentence where the answer is none.
inline std::string code_of(const HttpAnswer& answer)
{
    if (answer.header("content-type") != "application/problem+json")
        return "no problem but " + answer.header("content-type");
    const auto json = nlohmann::json::parse(answer.body);
    if (json.at("status") != answer.status) return "status differs";
    if (json.at("request_id") != answer.header("x-request-id")) return "request id differs";
    return json.at("code").get<std::string>();
}

inline nlohmann::json json_of(const HttpAnswer& answer)
{
    return nlohmann::json::parse(answer.body);
}

} // namespace tests
