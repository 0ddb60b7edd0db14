// heliograph-bench rays: million rays a second, build time and memory on one mesh, beside Embree in the same
// run.
#include "renderer/parallel/thread_pool.h"
#include "tests/bench/bench_mesh.h"
#include "tests/bench/commands.h"
#include "tests/bench/counted.h"
#include "tests/bench/ray_engine.h"
#include "tests/bench/ray_report.h"
#include "tests/bench/stopwatch.h"
#include "tests/bench/terrain.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

namespace bench {

namespace {

using namespace renderer;

using Engines = std::vector<std::unique_ptr<RayEngine>>;

// Rays that a thread claims together.
constexpr std::size_t kChunk = 4096;

// The mesh at one size.
struct Case {
    Mesh mesh;
    Engines engines;
    RayReport report;
    double scale = 1;
};

// Engines take turns within every repeat, and every repeat begins with another, so that what disturbs the machine
// disturbs them alike.
template <typename Measure>
void take_turns(std::size_t engines, int repeats, const Measure& measure)
{
    for (int repeat = 0; repeat < repeats; ++repeat)
        for (std::size_t i = 0; i < engines; ++i)
            measure((i + static_cast<std::size_t>(repeat)) % engines);
}

void measure_builds(Case& c, const RaysOptions& options)
{
    const int builds = options.builds.value_or(options.repeats);
    if (builds == 0) return;
    for (const unsigned threads : options.threads) {
        std::vector<std::vector<double>> cpu(c.engines.size()), wall(c.engines.size());
        take_turns(c.engines.size(), builds, [&](std::size_t e) {
            const auto same_tree = [&](const auto& other) { return other->tree() == c.engines[e]->tree(); };
            if (std::find_if(c.engines.begin(), c.engines.end(), same_tree)->get() != c.engines[e].get())
                return;
            const RayEngine::BuildCost cost = c.engines[e]->time_build(threads);
            cpu[e].push_back(1e3 * cost.cpu_s);
            wall[e].push_back(1e3 * cost.wall_s);
        });
        for (std::size_t e = 0; e < c.engines.size(); ++e) {
            std::size_t timed = 0;
            while (c.engines[timed]->tree() != c.engines[e]->tree())
                ++timed;
            c.report.engines[e].builds.push_back({threads, spread_of(cpu[timed]), spread_of(wall[timed])});
        }
    }
}

struct Traced {
    Spent spent; // cpu: the mean of the threads
    std::uint64_t hits = 0;
};

// All rays of a set, in chunks that threads claim in order.
Traced trace_all(const RayEngine& engine, const RaySet& set, ThreadPool& pool, unsigned threads)
{
    std::atomic<std::uint64_t> hits{0};
    std::vector<double> cpu(threads, 0);
    const std::span<const FloatRay> rays(set.rays);
    const Stopwatch watch(CLOCK_MONOTONIC);
    pool.run((rays.size() + kChunk - 1) / kChunk,
             [&](std::size_t i, unsigned worker) {
                 const Stopwatch chunk(CLOCK_THREAD_CPUTIME_ID);
                 hits +=
                     engine.trace(set, rays.subspan(i * kChunk, std::min(kChunk, rays.size() - i * kChunk)));
                 cpu[worker] += chunk.spent().cpu_s;
             },
             {},
             threads);
    Traced traced{watch.spent(), hits};
    traced.spent.cpu_s = 0;
    for (const double one : cpu)
        traced.spent.cpu_s += one / threads;
    return traced;
}

// The same, where callgrind may count it: twice, since its caches are empty at first, and the lines that the second
// pass fetches are those that stay to be fetched.
Traced trace_counted(const RayEngine& engine, const RaySet& set, ThreadPool& pool, unsigned threads)
{
    if (!CountedWork::is_possible()) return trace_all(engine, set, pool, threads);
    const auto label = [&](const char* caches) {
        return nlohmann::json{
            {"set", set.name}, {"engine", engine.name()}, {"rays", set.rays.size()}, {"caches", caches}}
            .dump();
    };
    const std::string cold = label("cold"), warm = label("warm");
    CountedWork counted;
    trace_all(engine, set, pool, threads);
    counted.dump(cold);
    const Traced traced = trace_all(engine, set, pool, threads);
    counted.dump(warm);
    return traced;
}

void measure_set(Case& c, const RaySet& set, const RaysOptions& options)
{
    for (EngineReport& engine : c.report.engines)
        engine.sets.push_back({set.name, {}, std::nullopt});
    const auto million = static_cast<double>(set.rays.size()) / 1e6;
    for (const unsigned threads : options.threads) {
        ThreadPool pool(threads);
        std::vector<RayFigures> figures(c.engines.size());
        std::vector<std::vector<double>> wall(c.engines.size());
        take_turns(c.engines.size(), options.repeats, [&](std::size_t e) {
            const Traced traced = trace_counted(*c.engines[e], set, pool, threads);
            figures[e].cpu_repeats.push_back(million / traced.spent.cpu_s);
            wall[e].push_back(million / traced.spent.wall_s);
            figures[e].hits = traced.hits;
        });
        for (std::size_t e = 0; e < c.engines.size(); ++e) {
            RayFigures& f = figures[e];
            f.threads = threads;
            f.rays = set.rays.size();
            f.cpu = spread_of(f.cpu_repeats);
            f.wall = spread_of(wall[e]);
            c.report.engines[e].sets.back().figures.push_back(std::move(f));
        }
    }
    if (!c.report.engines.front().ours) return; // nobody to hold the others against
    const auto answers_of = [&](const RayEngine& engine) {
        std::vector<FoundHit> found(set.rays.size());
        engine.trace(set, set.rays, found.data());
        return found;
    };
    const std::vector<FoundHit> ours = answers_of(*c.engines.front());
    for (std::size_t e = 1; e < c.engines.size(); ++e)
        c.report.engines[e].sets.back().differences =
            compare_hits(c.mesh, set, {*c.engines.front(), ours}, {*c.engines[e], answers_of(*c.engines[e])});
}

// Whole chunks stay, so that rays keep most of the neighbours that they run alike with.
void keep_every(std::size_t nth, RaySet& set)
{
    if (nth == 1) return;
    std::vector<FloatRay> kept;
    for (std::size_t first = 0; first < set.rays.size(); first += nth * kChunk)
        kept.insert(kept.end(),
                    set.rays.begin() + static_cast<std::ptrdiff_t>(first),
                    set.rays.begin() +
                        static_cast<std::ptrdiff_t>(std::min(first + kChunk, set.rays.size())));
    set.rays = std::move(kept);
}

std::vector<RaySet> sets_of(const Case& c, const RaysOptions& options)
{
    ThreadPool pool;
    const auto bvh =
        MeshBvh::build(c.mesh, {0, static_cast<std::uint32_t>(c.mesh.triangles.size())}, BvhSplit::sah, pool);
    View view = view_of_object(bvh->bounds());
    if (options.view == "nave") view = scaled(view_of_nave(), c.scale);
    std::vector<RaySet> sets = make_ray_sets(c.mesh, *bvh, view);
    if (!options.only.empty())
        std::erase_if(sets, [&](const RaySet& set) {
            return std::find(options.only.begin(), options.only.end(), set.name) == options.only.end();
        });
    if (sets.empty()) throw std::runtime_error("no ray set has such a name");
    for (RaySet& set : sets)
        keep_every(options.every, set);
    return sets;
}

std::string in_small_letters(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return text;
}

// Where its name contains one of the texts, or there is none.
bool is_asked_for(const RayEngine& engine, const std::vector<std::string>& texts)
{
    return texts.empty() || std::any_of(texts.begin(), texts.end(), [&](const std::string& text) {
               return in_small_letters(engine.name()).find(in_small_letters(text)) != std::string::npos;
           });
}

// Filled in place: engines refer to the mesh.
void prepare_case(Case& c, const Mesh& native, double diagonal, const RaysOptions& options)
{
    c.mesh = native;
    if (diagonal > 0) {
        c.scale = diagonal / diagonal_of(native);
        scale_mesh(c.mesh, c.scale);
    }
    const BvhSplit split = split_named(options.split);
    Engines made = make_heliograph_engines(c.mesh, split, options.every_kernel);
    const std::size_t ours = made.size();
    if (options.peer == "embree") {
        Engines peers = make_embree_engines(c.mesh);
        if (peers.empty())
            throw std::runtime_error("this build has no Embree: install libembree-dev and configure again");
        std::move(peers.begin(), peers.end(), std::back_inserter(made));
    }
    c.report = {.mesh = options.terrain != 0 ? "terrain" : options.mesh,
                .view = options.view,
                .triangles = c.mesh.triangles.size(),
                .diagonal = diagonal_of(c.mesh),
                .native = diagonal <= 0,
                .repeats = options.repeats,
                .every = options.every,
                .engines = {}};
    std::string names;
    for (std::size_t e = 0; e < made.size(); ++e) {
        names += "\n  " + made[e]->name();
        if (!is_asked_for(*made[e], options.engines)) continue;
        c.report.engines.push_back({.name = made[e]->name(),
                                    .tree = made[e]->tree(),
                                    .ours = e < ours,
                                    .high_quality = made[e]->high_quality(),
                                    .builds = {},
                                    .sets = {}});
        c.engines.push_back(std::move(made[e]));
    }
    if (c.engines.empty()) throw std::runtime_error("no engine has such a name; there are" + names);
}

void trace_case(Case& c, const RaysOptions& options)
{
    const auto triangles = static_cast<double>(c.mesh.triangles.size());
    for (std::size_t e = 0; e < c.engines.size(); ++e) {
        c.engines[e]->build();
        c.report.engines[e].bytes_per_triangle = static_cast<double>(c.engines[e]->bytes()) / triangles;
        c.report.engines[e].vertex_bytes_per_triangle =
            static_cast<double>(c.engines[e]->vertex_bytes()) / triangles;
    }
    for (const RaySet& set : sets_of(c, options))
        measure_set(c, set, options);
    c.engines.clear();
}

void write_json(const std::vector<RayReport>& reports, const std::string& path)
{
    const std::string text = to_json(reports).dump(2) + "\n";
    if (path == "-") {
        std::cout << text;
        return;
    }
    std::ofstream file(path);
    if (!(file << text) || !file.flush()) throw std::runtime_error("cannot write " + path);
}

} // namespace

void run_rays(const RaysOptions& options)
{
    std::vector<Case> cases(options.diagonals.size());
    {
        if (options.mesh.empty() == (options.terrain == 0))
            throw std::runtime_error("rays needs either --mesh or --terrain");
        const Mesh native = options.terrain != 0 ? terrain_mesh(options.terrain) : read_mesh(options.mesh);
        for (std::size_t i = 0; i < cases.size(); ++i)
            prepare_case(cases[i], native, options.diagonals[i], options);
    }
    // All builds first: tracing leaves threads of Embree's behind.
    for (Case& c : cases)
        measure_builds(c, options);
    std::vector<RayReport> reports;
    for (Case& c : cases) {
        trace_case(c, options);
        if (options.json.empty() || options.table) print_table(c.report, stdout);
        reports.push_back(std::move(c.report));
    }
    if (!options.json.empty()) write_json(reports, options.json);
}

} // namespace bench
