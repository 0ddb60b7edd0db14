#include "renderer/pass_schedule.h"
#include "renderer/render.h"
#include "renderer/tile_grid.h"
#include "renderer/trace.h"
#include "tests/bench/evaluation.h"
#include "tests/bench/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <memory>
#include <stdexcept>
#include <variant>

namespace bench {

using namespace renderer;

namespace {

struct Ready {
    RenderSettings settings;
    Plan plan;
    std::shared_ptr<const Scene> scene;
    double prepare_cpu_s = 0;
};

Ready make_ready(const Subject& subject, const AccelerationSettings& acceleration, ThreadPool& pool)
{
    Ready ready{subject.settings, {}, {}, 0};
    ready.settings.acceleration = acceleration;
    std::vector<MeshFacts> facts;
    for (const Mesh& mesh : subject.meshes)
        facts.push_back(facts_of(mesh));
    const ImageSettings& image = subject.settings.image;
    const AssumedScene scene = assume_defaults(
        subject.scene, facts, static_cast<double>(image.width_px) / static_cast<double>(image.height_px));
    auto planned = make_plan(scene, facts, ready.settings, Limits::none());
    if (const auto* const faults = std::get_if<std::vector<Fault>>(&planned))
        throw std::runtime_error(faults->front().pointer + ": " + faults->front().detail);
    ready.plan = std::move(std::get<Plan>(planned));
    std::vector<Mesh> meshes = subject.meshes;
    const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
    std::vector<std::shared_ptr<const PreparedMesh>> prepared;
    for (std::size_t i = 0; i < meshes.size(); ++i)
        prepared.push_back(prepare_mesh(std::move(meshes[i]), ready.plan.mesh_trees[i], pool));
    ready.scene = prepare(scene, ready.plan, prepared, ready.settings, pool);
    ready.prepare_cpu_s = watch.spent().cpu_s;
    return ready;
}

// A tile as std::async's callers do it: all its samples, then back with the sums.
std::vector<TileSums> trace_tile(const Ready& ready, const PixelRect& tile)
{
    const std::uint32_t samples = ready.settings.quality.samples.value();
    std::vector<TileSums> slices;
    for (std::uint32_t slice = 0; samples_of_slice(slice).first < samples; ++slice) {
        const SampleRange range = samples_of_slice(slice);
        const WorkUnit unit{tile, {range.first, std::min(range.end, samples)}};
        slices.push_back(std::move(trace(*ready.scene, ready.plan, ready.settings.seed, unit, {})->sums));
    }
    return slices;
}

Film render_async(const Ready& ready, std::uint32_t tile_side_px)
{
    const ImageSettings& image = ready.settings.image;
    Film film(PixelRect{0, 0, image.width_px, image.height_px});
    const TileGrid grid(film.region, tile_side_px);
    std::deque<std::future<std::vector<TileSums>>> tiles;
    const auto merge_first = [&] {
        for (const TileSums& slice : tiles.front().get())
            film.merge(slice);
        tiles.pop_front();
    };
    // Each is a thread until it is merged, also when it is done: a system has no room for one a pixel at once.
    constexpr std::size_t kMostThreads = 1000;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (tiles.size() == kMostThreads) merge_first();
        tiles.push_back(std::async(std::launch::async,
                                   [&ready, tile = grid.tile(i)] { return trace_tile(ready, tile); }));
    }
    while (!tiles.empty())
        merge_first();
    film.samples = ready.settings.quality.samples.value();
    return film;
}

Film render_once(const Ready& ready, Scheduler scheduler, ThreadPool& pool)
{
    switch (scheduler) {
    case Scheduler::pool:
        return render(*ready.scene, ready.plan, ready.settings, pool).value().film;
    case Scheduler::async_a_tile:
        return render_async(ready, ready.settings.acceleration.tile_px);
    case Scheduler::async_a_pixel:
        return render_async(ready, 1);
    }
    throw std::logic_error("no such scheduler");
}

double relative_rmse(const Film& film, const Film& truth)
{
    const LinearImage a = film.mean(), b = truth.mean();
    double error = 0, size = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        for (const auto channel : {&Rgb::r, &Rgb::g, &Rgb::b}) {
            const double x = static_cast<double>(a.pixels[i].*channel),
                         y = static_cast<double>(b.pixels[i].*channel);
            error += (x - y) * (x - y);
            size += y * y;
        }
    return std::sqrt(error / size);
}

Film many_samples(const Subject& subject, ThreadPool& pool)
{
    Subject converged = subject;
    converged.settings.quality.samples = 64 * subject.settings.quality.samples.value();
    return render_once(make_ready(converged, {}, pool), Scheduler::pool, pool);
}

// One variant, being measured.
struct Contestant {
    Variant variant;
    std::unique_ptr<ThreadPool> pool;
    Ready ready;
    std::uint32_t pictures = 1;
    std::vector<double> wall_s, cpu_s, prepare_cpu_s;
    bool same = true;
};

void measure(Contestant& c, const Film& want)
{
    const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
    std::optional<Film> film;
    for (std::uint32_t i = 0; i < c.pictures; ++i)
        film = render_once(c.ready, c.variant.scheduler, *c.pool);
    const Spent spent = watch.spent();
    c.wall_s.push_back(spent.wall_s / c.pictures);
    c.cpu_s.push_back(spent.cpu_s / c.pictures);
    c.same = c.same && film->sums == want.sums;
}

std::uint64_t triangles_of_all(const Subject& subject)
{
    std::uint64_t triangles = 0;
    for (const ObjectDescription& object : subject.scene.objects)
        if (const auto* const mesh = std::get_if<MeshShape>(&object.shape))
            triangles += subject.meshes[mesh->mesh].triangles.size();
        else if (std::holds_alternative<RectangleShape>(object.shape))
            triangles += 2;
    return triangles;
}

} // namespace

Comparison compare(const Subject& subject, const std::vector<Variant>& variants, int repeats)
{
    constexpr double kLeast_s = 0.1; // of a measurement, or clocks and scheduling would show
    ThreadPool every_core;
    const Film want = render_once(make_ready(subject, {}, every_core), Scheduler::pool, every_core);
    std::vector<Contestant> contestants;
    for (const Variant& variant : variants) {
        Contestant& c = contestants.emplace_back();
        c.variant = variant;
        c.pool = std::make_unique<ThreadPool>(variant.acceleration.threads);
        c.ready = make_ready(subject, variant.acceleration, *c.pool);
        c.prepare_cpu_s.push_back(c.ready.prepare_cpu_s);
        const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID); // and what is touched for the first time is touched
        if (render_once(c.ready, variant.scheduler, *c.pool).sums != want.sums) c.same = false;
        const double share = kLeast_s / std::max(watch.spent().cpu_s, 1e-6);
        c.pictures = static_cast<std::uint32_t>(std::clamp(std::ceil(share), 1.0, 1000.0));
    }
    for (int repeat = 0; repeat < repeats; ++repeat)
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            Contestant& c = contestants[(i + static_cast<std::size_t>(repeat)) % contestants.size()];
            measure(c, want);
            if (repeat != 0)
                c.prepare_cpu_s.push_back(make_ready(subject, c.variant.acceleration, *c.pool).prepare_cpu_s);
        }
    Comparison result{.subject = subject.name,
                      .triangles = triangles_of_all(subject),
                      .objects = subject.scene.objects.size(),
                      .width_px = subject.settings.image.width_px,
                      .height_px = subject.settings.image.height_px,
                      .samples = subject.settings.quality.samples.value(),
                      .relative_rmse = relative_rmse(want, many_samples(subject, every_core)),
                      .rows = {}};
    for (const Contestant& c : contestants)
        result.rows.push_back({.variant = c.variant.name,
                               .acceleration = c.variant.acceleration,
                               .scheduler = c.variant.scheduler,
                               .threads = c.pool->size(),
                               .wall_s = spread_of(c.wall_s),
                               .cpu_s = spread_of(c.cpu_s),
                               .prepare_cpu_s = spread_of(c.prepare_cpu_s),
                               .pictures = c.pictures,
                               .same_picture = c.same});
    return result;
}

} // namespace bench
