// heliograph-bench pictures: whole pictures: seconds and samples a second of each scene, on one thread and on all.
//
// Scenes are job files, as heliograph render takes them; without any, the ones built in: a Cornell box lit by
// paths, and the same by direct light alone. cpu is the time of all threads; samples a second are camera paths.
#include "api/job_request.h"
#include "clients/cli/local_job.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/render.h"
#include "tests/bench/commands.h"
#include "tests/bench/spread.h"
#include "tests/bench/stopwatch.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace bench {

namespace {

using nlohmann::json;

// The box of the classic experiment: walls 0.73, red and green, two blocks, a lamp of radiance 17.
json cornell(const char* transport)
{
    const auto wall = [](const char* material, json steps) {
        return json{{"shape", "rectangle"},
                    {"size", {2, 2}},
                    {"material", material},
                    {"transform", std::move(steps)}};
    };
    const auto turn = [](double degrees, json axis) {
        return json{{"rotate_deg", degrees}, {"axis", std::move(axis)}};
    };
    const auto move = [](double x, double y, double z) { return json{{"translate", {x, y, z}}}; };
    const auto block = [&](double height, double degrees, double x, double z) {
        return json{{"shape", "box"},
                    {"size", {0.6, height, 0.6}},
                    {"material", "white"},
                    {"transform", {turn(degrees, {0, 1, 0}), move(x, height / 2, z)}}};
    };
    const auto paint = [](double r, double g, double b) {
        return json{{"type", "diffuse"}, {"color", {r, g, b}}};
    };
    return {{"scene",
             {{"camera", {{"position", {0, 1, 3.9}}, {"look_at", {0, 1, 0}}, {"fov_deg", 39}}},
              {"environment", {{"type", "none"}}},
              {"materials",
               {{"white", paint(0.73, 0.73, 0.73)},
                {"red", paint(0.65, 0.05, 0.05)},
                {"green", paint(0.12, 0.45, 0.15)}}},
              {"objects",
               {wall("white", {turn(-90, {1, 0, 0})}),
                wall("white", {turn(90, {1, 0, 0}), move(0, 2, 0)}),
                wall("white", {move(0, 1, -1)}),
                wall("red", {turn(90, {0, 1, 0}), move(-1, 1, 0)}),
                wall("green", {turn(-90, {0, 1, 0}), move(1, 1, 0)}),
                block(0.6, -18, 0.33, 0.37),
                block(1.2, 17, -0.33, -0.28)}},
              {"lights",
               {{{"type", "rectangle"},
                 {"size", {0.5, 0.4}},
                 {"radiance", {17, 17, 17}},
                 {"transform", {turn(90, {1, 0, 0}), move(0, 1.98, 0)}}}}},
              {"transport", {{"type", transport}}}}}};
}

struct Made {
    renderer::Plan plan;
    std::shared_ptr<const renderer::Scene> scene;
    renderer::RenderSettings settings;
};

Made make(const clients::JobSource& source, const PicturesOptions& options, renderer::ThreadPool& pool)
{
    clients::LocalJob job = clients::load_local_job(source, clients::read_request(source));
    renderer::RenderSettings settings = job.request.settings;
    settings.image.height_px = options.side_px * settings.image.height_px / settings.image.width_px;
    settings.image.width_px = options.side_px;
    settings.image.region.reset();
    settings.quality = {.samples = options.samples, .time_s = {}};
    job.request.settings = settings;
    renderer::Plan plan = clients::plan_of(job);
    std::vector<std::shared_ptr<const renderer::PreparedMesh>> meshes;
    for (std::size_t i = 0; i < job.meshes.size(); ++i)
        meshes.push_back(renderer::prepare_mesh(std::move(job.meshes[i]), plan.mesh_trees[i], pool));
    auto scene = renderer::prepare(job.assumed, plan, meshes, settings, pool);
    return {std::move(plan), std::move(scene), settings};
}

json measure(const std::string& name, const Made& made, unsigned threads, int repeats)
{
    renderer::ThreadPool pool(threads);
    std::vector<double> wall, cpu;
    renderer::RenderReport report;
    for (int i = 0; i < repeats; ++i) {
        const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
        report = renderer::render(*made.scene, made.plan, made.settings, pool, {})->report;
        const Spent spent = watch.spent();
        wall.push_back(spent.wall_s);
        cpu.push_back(spent.cpu_s);
    }
    const auto rays = static_cast<double>(report.timing.camera_rays + report.timing.shadow_rays +
                                          report.timing.bounce_rays);
    const auto samples = static_cast<double>(report.timing.camera_rays);
    const double wall_s = spread_of(wall).median, cpu_s = spread_of(cpu).median;
    return {{"scene", name},
            {"threads", threads},
            {"wall_s", wall_s},
            {"cpu_s", cpu_s},
            {"million_samples_per_cpu_s", samples / cpu_s / 1e6},
            {"million_samples_per_s", samples / wall_s / 1e6},
            {"million_rays_per_cpu_s", rays / cpu_s / 1e6},
            {"rays_per_sample", rays / samples}};
}

} // namespace

void run_pictures(const PicturesOptions& options)
{
    std::vector<clients::JobSource> sources;
    for (const std::string& scene : options.scenes)
        sources.push_back(clients::read_job_source(scene));
    if (sources.empty())
        for (const char* transport : {"path", "direct"})
            sources.push_back({std::string("cornell ") + transport, cornell(transport).dump(), "."});
    json all = json::array();
    if (!options.json)
        std::printf("%-28s %7s %9s %9s %18s %16s %8s\n",
                    "scene",
                    "threads",
                    "wall s",
                    "cpu s",
                    "Msamples / cpu s",
                    "Mrays / cpu s",
                    "rays");
    renderer::ThreadPool pool(0);
    for (const clients::JobSource& source : sources) {
        const Made made = make(source, options, pool);
        for (const unsigned threads : {1u, std::thread::hardware_concurrency()}) {
            const json row = measure(source.name, made, threads, options.repeats);
            if (!options.json)
                std::printf("%-28s %7u %9.3f %9.3f %18.3f %16.3f %8.2f\n",
                            source.name.c_str(),
                            threads,
                            row["wall_s"].get<double>(),
                            row["cpu_s"].get<double>(),
                            row["million_samples_per_cpu_s"].get<double>(),
                            row["million_rays_per_cpu_s"].get<double>(),
                            row["rays_per_sample"].get<double>());
            all.push_back(row);
        }
    }
    if (options.json) std::printf("%s\n", all.dump(2).c_str());
}

} // namespace bench
