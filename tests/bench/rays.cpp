// heliograph-bench rays: million rays a second, build time and memory on one mesh, beside Embree in the same
// run.
#include "renderer/io/import_mesh.h"
#include "renderer/parallel/thread_pool.h"
#include "tests/bench/commands.h"
#include "tests/bench/ray_engine.h"

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace bench {

namespace {

using namespace renderer;
using Clock = std::chrono::steady_clock;

struct Options {
    std::string mesh, view = "object", peer, split = "sah";
    std::vector<std::string> only;
    bool json = false, every_kernel = false;
    unsigned threads = 1;
    int repeats = 5;
};

struct Column {
    double million_per_s = 0;
    std::uint64_t hits = 0, rays = 0;
};

struct Row {
    std::string engine;
    double build_ms = 0;
    double bytes_per_triangle = 0, vertex_bytes_per_triangle = 0;
    std::vector<Column> columns;
};

Mesh read_mesh(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto nothing_else = [](std::string_view) { return std::optional<std::span<const std::byte>>(); };
    ImportResult result = import_mesh(path, std::as_bytes(std::span(bytes)), nothing_else, Limits::none());
    if (const ImportFault* fault = std::get_if<ImportFault>(&result))
        throw std::runtime_error(path + ": " + fault->detail);
    return std::move(std::get<ImportedMesh>(result).mesh);
}

double median(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

template <typename Work>
double seconds(const Work& work)
{
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// All rays of a set, in chunks that threads claim in order.
std::uint64_t trace_all(const RayEngine& engine, const RaySet& set, ThreadPool& pool, unsigned threads)
{
    constexpr std::size_t kChunk = 4096;
    std::atomic<std::uint64_t> hits{0};
    const std::span<const FloatRay> rays(set.rays);
    pool.run((rays.size() + kChunk - 1) / kChunk,
             [&](std::size_t i, unsigned) {
                 hits +=
                     engine.trace(set, rays.subspan(i * kChunk, std::min(kChunk, rays.size() - i * kChunk)));
             },
             {},
             threads);
    return hits;
}

// Engines take turns within every repeat, so that what disturbs the machine disturbs them alike.
std::vector<Row> measure(const std::vector<std::unique_ptr<RayEngine>>& engines,
                         const std::vector<RaySet>& sets,
                         const Options& options,
                         double triangles)
{
    ThreadPool pool(options.threads);
    std::vector<Row> rows(engines.size());
    std::vector<std::vector<double>> builds(engines.size());
    for (int repeat = 0; repeat < options.repeats; ++repeat)
        for (std::size_t e = 0; e < engines.size(); ++e)
            builds[e].push_back(seconds([&] { engines[e]->build(); }));
    for (std::size_t e = 0; e < engines.size(); ++e) {
        rows[e].engine = engines[e]->name();
        rows[e].build_ms = 1e3 * median(builds[e]);
        rows[e].bytes_per_triangle = static_cast<double>(engines[e]->bytes()) / triangles;
        rows[e].vertex_bytes_per_triangle = static_cast<double>(engines[e]->vertex_bytes()) / triangles;
    }
    for (const RaySet& set : sets) {
        std::vector<std::vector<double>> times(engines.size());
        for (Row& row : rows)
            row.columns.push_back({0, 0, set.rays.size()});
        for (int repeat = 0; repeat < options.repeats; ++repeat)
            for (std::size_t e = 0; e < engines.size(); ++e)
                times[e].push_back(seconds([&] {
                    rows[e].columns.back().hits = trace_all(*engines[e], set, pool, options.threads);
                }));
        for (std::size_t e = 0; e < engines.size(); ++e)
            rows[e].columns.back().million_per_s =
                static_cast<double>(set.rays.size()) / median(times[e]) / 1e6;
    }
    return rows;
}

void print_table(const std::vector<Row>& rows, const std::vector<RaySet>& sets)
{
    std::printf("%-30s", "million rays a second");
    for (const RaySet& set : sets)
        std::printf(" %22s", set.name.c_str());
    std::printf(" %10s %8s %10s\n", "build ms", "B/tri", "+vertices");
    for (const Row& row : rows) {
        std::printf("%-30s", row.engine.c_str());
        for (const Column& column : row.columns)
            std::printf(" %22.2f", column.million_per_s);
        std::printf(
            " %10.1f %8.1f %10.1f\n", row.build_ms, row.bytes_per_triangle, row.vertex_bytes_per_triangle);
    }
    std::printf("%-30s\n", "hits");
    for (const Row& row : rows) {
        std::printf("%-30s", row.engine.c_str());
        for (const Column& column : row.columns)
            std::printf(" %11llu/%10llu",
                        static_cast<unsigned long long>(column.hits),
                        static_cast<unsigned long long>(column.rays));
        std::printf("\n");
    }
    if (rows.size() < 2) return;
    std::printf("%-30s\n", "Heliograph over the peer (build and bytes: less is better)");
    for (std::size_t i = 1; i < rows.size(); ++i) {
        std::printf("%-30s", rows[i].engine.c_str());
        for (std::size_t c = 0; c < sets.size(); ++c)
            std::printf(" %22.2f", rows[0].columns[c].million_per_s / rows[i].columns[c].million_per_s);
        std::printf(" %10.2f %8.2f\n",
                    rows[0].build_ms / rows[i].build_ms,
                    rows[0].bytes_per_triangle / rows[i].bytes_per_triangle);
    }
}

void print_json(const std::vector<Row>& rows,
                const std::vector<RaySet>& sets,
                const Options& options,
                std::size_t triangles)
{
    nlohmann::json document{{"mesh", options.mesh},
                            {"triangles", triangles},
                            {"threads", options.threads},
                            {"repeats", options.repeats},
                            {"engines", nlohmann::json::array()}};
    for (const Row& row : rows) {
        nlohmann::json engine{{"name", row.engine},
                              {"build_ms", row.build_ms},
                              {"bytes_per_triangle", row.bytes_per_triangle},
                              {"vertex_bytes_per_triangle", row.vertex_bytes_per_triangle}};
        for (std::size_t c = 0; c < sets.size(); ++c)
            engine["rays"][sets[c].name] = {{"million_per_s", row.columns[c].million_per_s},
                                            {"hits", row.columns[c].hits},
                                            {"rays", row.columns[c].rays}};
        document["engines"].push_back(engine);
    }
    std::cout << document.dump(2) << "\n";
}

void run(const Options& options)
{
    const Mesh mesh = read_mesh(options.mesh);
    const BvhSplit split = options.split == "sah" ? BvhSplit::sah : BvhSplit::midpoint;
    std::vector<RaySet> sets;
    {
        ThreadPool pool;
        const auto bvh =
            MeshBvh::build(mesh, {0, static_cast<std::uint32_t>(mesh.triangles.size())}, split, pool);
        sets = make_ray_sets(
            mesh, *bvh, options.view == "nave" ? view_of_nave() : view_of_object(bvh->bounds()));
    }
    if (!options.only.empty())
        std::erase_if(sets, [&](const RaySet& set) {
            return std::find(options.only.begin(), options.only.end(), set.name) == options.only.end();
        });
    auto engines = make_heliograph_engines(mesh, split, options.every_kernel);
    if (options.peer == "embree") {
        auto peers = make_embree_engines(mesh);
        if (peers.empty())
            throw std::runtime_error("this build has no Embree: install libembree-dev and configure again");
        std::move(peers.begin(), peers.end(), std::back_inserter(engines));
    }
    const auto rows = measure(engines, sets, options, static_cast<double>(mesh.triangles.size()));
    if (options.json)
        print_json(rows, sets, options, mesh.triangles.size());
    else
        print_table(rows, sets);
}

} // namespace

void add_rays(CLI::App& app)
{
    CLI::App* const command =
        app.add_subcommand("rays", "million rays a second on one mesh, build time and memory");
    const auto options = std::make_shared<Options>();
    command->add_option("--mesh", options->mesh, "mesh file")->required();
    command->add_option("--view", options->view, "object: from outside; nave: within Sponza or the museum")
        ->check(CLI::IsMember({"object", "nave"}))
        ->capture_default_str();
    command->add_option("--peer", options->peer, "engine to measure beside ours")
        ->check(CLI::IsMember({"embree"}));
    command->add_option("--split", options->split, "how our tree is built")
        ->check(CLI::IsMember({"sah", "midpoint"}))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "threads that trace; builds use one")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_option("--repeats", options->repeats, "the median is told")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--only", options->only, "ray sets to trace: primary, shadow, diffuse, ...");
    command->add_flag("--kernels", options->every_kernel, "every kernel of ours, not only the best");
    command->add_flag("--json", options->json, "JSON instead of the table");
    command->callback([options] { run(*options); });
}

} // namespace bench
