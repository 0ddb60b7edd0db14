// heliograph-bench service: what the service costs beyond the render itself.
//
// overhead POST to picture of a 64x64 scene whose mesh is known, less the seconds that its report says were
// spent preparing and rendering; beside it one fdatasync of 4 KiB in the same folder, measured in turn.
// submissions accepted a second from 64 clients. status GET of a job's status while every core renders,
// median and 99th percentile. first tile (--first-tile MESH) from POST of a job on a mesh that is prepared to the
// picture of one 16x16 tile of it, one sample a pixel; beside it what the report says preparing and rendering
// took, and the same once the service was started anew. memory resident, right after start, and after all of this.
#include "tests/bench/child_service.h"
#include "tests/bench/commands.h"

#include <httplib.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace bench {

namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

double ms_since(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double quantile(std::vector<double> values, double q)
{
    std::sort(values.begin(), values.end());
    return values.at(static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

constexpr const char* kTetrahedron =
    "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

// A scene of one mesh and one light; the seed makes each job its own render.
std::string job_text(const std::string& mesh_digest, int side_px, int samples, int seed)
{
    return json{
        {"scene",
         {{"objects", {{{"mesh", mesh_digest}}}},
          {"lights", {{{"type", "directional"}, {"direction", {-1, -1, -1}}, {"irradiance", {3, 3, 3}}}}}}},
        {"image", {{"width", side_px}, {"height", side_px}}},
        {"quality", {{"samples", samples}}},
        {"seed", seed}}
        .dump();
}

const httplib::Response& checked(const httplib::Result& result, int status)
{
    if (!result) throw std::runtime_error("no answer: " + httplib::to_string(result.error()));
    if (result->status != status)
        throw std::runtime_error("status " + std::to_string(result->status) + ": " + result->body);
    return *result;
}

double fdatasync_ms(const std::filesystem::path& folder)
{
    const int fd = open((folder / "fdatasync").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    const std::string page(4096, 'x');
    const Clock::time_point start = Clock::now();
    const bool ok =
        write(fd, page.data(), page.size()) == static_cast<ssize_t>(page.size()) && fdatasync(fd) == 0;
    const double ms = ms_since(start);
    close(fd);
    if (!ok) throw std::runtime_error("fdatasync failed");
    return ms;
}

json measure_overhead(const ChildService& service, const std::string& mesh, int repeats)
{
    httplib::Client client(service.url());
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    std::vector<double> total, beyond, sync;
    for (int i = 0; i < repeats; ++i) {
        sync.push_back(fdatasync_ms(service.folder()));
        const std::string body = job_text(mesh, 64, 1, i);
        const Clock::time_point start = Clock::now();
        const httplib::Result answer = client.Post(
            "/v1/jobs", {{"Prefer", "wait=30"}, {"Accept", "image/png"}}, body, "application/json");
        total.push_back(ms_since(start));
        const httplib::Response& picture = checked(answer, 200);
        const std::string link = picture.get_header_value("Link");
        const std::string path = link.substr(link.find('/'), link.find('>') - link.find('/'));
        const json timing = json::parse(checked(client.Get(path), 200).body).at("timing");
        beyond.push_back(total.back() -
                         1000 * (timing.at("prepare_s").get<double>() + timing.at("render_s").get<double>()));
    }
    return {{"total_ms", quantile(total, 0.5)},
            {"beyond_render_ms", quantile(beyond, 0.5)},
            {"fdatasync_ms", quantile(sync, 0.5)},
            {"beyond_render_and_fdatasync_ms", quantile(beyond, 0.5) - quantile(sync, 0.5)},
            {"repeats", repeats}};
}

json measure_submissions(const ChildService& service, const std::string& mesh, int clients, int each)
{
    std::atomic<int> accepted{0}, refused{0};
    const Clock::time_point start = Clock::now();
    {
        std::vector<std::jthread> threads;
        for (int c = 0; c < clients; ++c)
            threads.emplace_back([&, c] {
                httplib::Client client(service.url());
                client.set_keep_alive(true);
                client.set_tcp_nodelay(true);
                for (int i = 0; i < each; ++i) {
                    const httplib::Result answer = client.Post(
                        "/v1/jobs", job_text(mesh, 1, 1, 1'000'000 + c * each + i), "application/json");
                    (answer && answer->status == 202 ? accepted : refused).fetch_add(1);
                }
            });
    }
    const double seconds = ms_since(start) / 1000;
    return {{"clients", clients},
            {"accepted", accepted.load()},
            {"refused", refused.load()},
            {"accepted_per_s", accepted / seconds}};
}

json measure_status(const ChildService& service, const std::string& mesh, int repeats)
{
    httplib::Client client(service.url());
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    const json job = json::parse(
        checked(client.Post("/v1/jobs", job_text(mesh, 2048, 4096, 7), "application/json"), 202).body);
    const std::string path = "/v1/jobs/" + job.at("id").get<std::string>();
    while (json::parse(checked(client.Get(path), 200).body).at("state") != "running")
        std::this_thread::yield();
    std::vector<double> times;
    for (int i = 0; i < repeats; ++i) {
        const Clock::time_point start = Clock::now();
        checked(client.Get(path), 200);
        times.push_back(ms_since(start));
    }
    checked(client.Delete(path), 204);
    return {{"median_ms", quantile(times, 0.5)}, {"p99_ms", quantile(times, 0.99)}, {"repeats", repeats}};
}

// One tile in the middle of a large picture.
std::string tile_text(const std::string& mesh_digest, int seed)
{
    json job = json::parse(job_text(mesh_digest, 1024, 1, seed));
    job["image"]["region"] = {{"x", 504}, {"y", 504}, {"width", 16}, {"height", 16}};
    return job.dump();
}

struct TileTimes {
    std::vector<double> total, prepare, render;
};

void measure_tile(httplib::Client& client, const std::string& mesh, int seed, TileTimes& times)
{
    const std::string body = tile_text(mesh, seed);
    const Clock::time_point start = Clock::now();
    const httplib::Result answer =
        client.Post("/v1/jobs", {{"Prefer", "wait=60"}, {"Accept", "image/png"}}, body, "application/json");
    times.total.push_back(ms_since(start));
    const std::string link = checked(answer, 200).get_header_value("Link");
    const std::string path = link.substr(link.find('/'), link.find('>') - link.find('/'));
    const json timing = json::parse(checked(client.Get(path), 200).body).at("timing");
    times.prepare.push_back(1000 * timing.at("prepare_s").get<double>());
    times.render.push_back(1000 * timing.at("render_s").get<double>());
}

std::string bytes_of(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    if (!(bytes << file.rdbuf())) throw std::runtime_error("cannot read " + path);
    return std::move(bytes).str();
}

void run_first_tile(const std::string& path, bool as_json)
{
    constexpr int kRepeats = 41;
    const ChildService service({"--limit-asset-bytes",
                                "4000000000",
                                "--limit-import-memory-bytes",
                                "16000000000",
                                "--limit-import-output-bytes",
                                "4000000000",
                                "--limit-import-s",
                                "600"});
    httplib::Client client(service.url());
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    client.set_read_timeout(600);
    TileTimes cold, warm;
    const Clock::time_point start = Clock::now();
    const std::string mesh =
        json::parse(checked(client.Post("/v1/assets", bytes_of(path), "application/octet-stream"), 201).body)
            .at("digest")
            .get<std::string>();
    const double upload_ms = ms_since(start);
    measure_tile(client, mesh, 0, cold);
    const double whole_ms = ms_since(start);
    for (int i = 1; i <= kRepeats; ++i)
        measure_tile(client, mesh, i, warm);
    const json figures{{"mesh", path},
                       {"upload_ms", upload_ms},
                       {"upload_to_first_tile_ms", whole_ms},
                       {"import_and_tree_ms", cold.prepare[0]},
                       {"first_tile_ms", quantile(warm.total, 0.5)},
                       {"first_tile_least_ms", quantile(warm.total, 0)},
                       {"prepare_ms", quantile(warm.prepare, 0.5)},
                       {"render_ms", quantile(warm.render, 0.5)},
                       {"fdatasync_ms", fdatasync_ms(service.folder())},
                       {"peak_mib", service.peak_mib()}};
    if (as_json) {
        std::cout << figures.dump(2) << "\n";
        return;
    }
    std::printf("%s: upload %.0f ms, to the first tile %.0f ms, of that import and tree %.0f ms\n",
                path.c_str(),
                upload_ms,
                whole_ms,
                cold.prepare[0]);
    std::printf("first tile of a prepared mesh: %.2f ms, least %.2f (preparing %.2f, rendering %.2f, one "
                "fdatasync %.2f)"
                "   goal: 20 ms\n",
                quantile(warm.total, 0.5),
                quantile(warm.total, 0),
                quantile(warm.prepare, 0.5),
                quantile(warm.render, 0.5),
                figures["fdatasync_ms"].get<double>());
}

} // namespace

void run_service(const ServiceOptions& options)
{
    if (!options.first_tile.empty()) return run_first_tile(options.first_tile, options.as_json);
    const ChildService service({"--limit-queue-jobs", "1000000"});
    json figures;
    figures["idle_resident_mib"] = service.resident_mib();
    httplib::Client client(service.url());
    const std::string mesh =
        json::parse(checked(client.Post("/v1/assets", kTetrahedron, "application/octet-stream"), 201).body)
            .at("digest")
            .get<std::string>();
    checked(client.Post("/v1/jobs", {{"Prefer", "wait=30"}}, job_text(mesh, 64, 1, 999), "application/json"),
            200);
    figures["job"] = measure_overhead(service, mesh, 101);
    figures["status_while_rendering"] = measure_status(service, mesh, 2000);
    figures["submissions"] = measure_submissions(service, mesh, 64, 50);
    figures["resident_after_mib"] = service.resident_mib();
    figures["peak_mib"] = service.peak_mib();
    if (options.as_json) {
        std::cout << figures.dump(2) << "\n";
        return;
    }
    const json& job = figures["job"];
    std::printf("job 64x64, mesh known: %.2f ms; beyond render %.2f ms = one fdatasync (%.2f ms) + %.2f ms   "
                "goal: + 2 ms\n",
                job["total_ms"].get<double>(),
                job["beyond_render_ms"].get<double>(),
                job["fdatasync_ms"].get<double>(),
                job["beyond_render_and_fdatasync_ms"].get<double>());
    std::printf("status while every core renders: median %.2f ms, p99 %.2f ms   goal: p99 under 5 ms\n",
                figures["status_while_rendering"]["median_ms"].get<double>(),
                figures["status_while_rendering"]["p99_ms"].get<double>());
    std::printf(
        "submissions: %.0f accepted a second from 64 clients (%d accepted, %d refused)   goal: 1,000\n",
        figures["submissions"]["accepted_per_s"].get<double>(),
        figures["submissions"]["accepted"].get<int>(),
        figures["submissions"]["refused"].get<int>());
    std::printf("memory: %.1f MiB idle, %.1f MiB after, %.1f MiB peak   goal: 30 MiB idle\n",
                figures["idle_resident_mib"].get<double>(),
                figures["resident_after_mib"].get<double>(),
                figures["peak_mib"].get<double>());
}

} // namespace bench
