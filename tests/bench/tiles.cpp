// heliograph-bench tiles: parallel efficiency of the tile loop, t(1) / (n t(n)), in one run: for a picture
// with work everywhere, and for one whose every costly pixel lies in a single 16x16 tile.
//
// Beside each pair of renders stand two controls on as many threads, which share nothing but the machine: `arithmetic` in
// registers, and `apart`, a whole render of its own for each thread. What they lose (one core's two hyper-threads, clocks,
// caches, other programs) no renderer can win; `ratio` is to `apart` and is the loop's own. `work` is cpu(1) / cpu(n), below 100 % where threads make each other
// slower; `busy` is cpu(n) / (n t(n)), below 100 % where they wait or are not let run.
#include "renderer/math/transcendental.h"
#include "renderer/render.h"
#include "tests/bench/commands.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace bench {

namespace {

using namespace renderer;

// A ball of many small spheres before the camera; the rest of the picture is empty.
SceneDescription ball_of_spheres()
{
    SceneDescription scene;
    scene.camera = CameraDescription{.position = {0, 0, 5}, .aim = {0, 0, 0}, .fov_deg = 30};
    scene.environment = ColorEnvironment{{0.5f, 0.5f, 0.5f}};
    scene.lights.push_back(PointLight{.position = {3, 4, 5}, .intensity = {40, 40, 40}});
    for (int i = 0; i < 500; ++i) {
        const double a = i * 2.399963, z = 1 - 2 * (i + 0.5) / 500; // points of a golden spiral
        const double r = std::sqrt(1 - z * z);
        const auto [s, c] = sin_cos(a);
        ObjectDescription& sphere = scene.objects.emplace_back();
        sphere.shape = SphereShape{0.1};
        sphere.world_from_object = Affine3::translate({r * c, r * s, z});
    }
    return scene;
}

struct Times {
    double wall_s = 0, cpu_s = 0; // of all threads
};

template <typename Work>
Times time_of(Work&& work)
{
    const auto cpu_now = [] {
        timespec t{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
    };
    const double cpu = cpu_now();
    const auto start = std::chrono::steady_clock::now();
    work();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), cpu_now() - cpu};
}

// Some 10 ms of multiplications and additions on a few chains, as shading has them. Never zero.
double arithmetic(std::size_t item)
{
    double a = 1 + 1e-9 * static_cast<double>(item), b = a + 0.1, c = a + 0.2, d = a + 0.3;
    for (int i = 0; i < 2'000'000; ++i) {
        a = a * 0.999999 + 1e-6;
        b = b * 0.999998 + 2e-6;
        c = c * 0.999997 + 3e-6;
        d = d * 0.999996 + 4e-6;
    }
    return a + b + c + d;
}

Times control(std::size_t items, unsigned threads, ThreadPool& pool)
{
    std::atomic<std::size_t> zeros = 0;
    const Times times = time_of([&] {
        pool.run(
            items, [&](std::size_t item, unsigned) { zeros += arithmetic(item) == 0; }, {}, threads);
    });
    if (zeros != 0) throw std::runtime_error("the control computed nothing");
    return times;
}

Times render_times(const AssumedScene& scene, RenderSettings settings, unsigned threads, ThreadPool& pool)
{
    settings.acceleration.threads = threads;
    const std::variant<Plan, std::vector<Fault>> planned = make_plan(scene, {}, settings, Limits::none());
    const Plan& plan = std::get<Plan>(planned);
    const std::shared_ptr<const Scene> ready = prepare(scene, plan, {}, settings, pool);
    return time_of([&] {
        if (!render(*ready, plan, settings, pool)) throw std::runtime_error("the render was stopped");
    });
}

// The picture once on each of `threads` threads, each with its own scene, pool and film.
Times apart_times(const AssumedScene& scene, RenderSettings settings, unsigned threads)
{
    settings.acceleration.threads = 1;
    const std::variant<Plan, std::vector<Fault>> planned = make_plan(scene, {}, settings, Limits::none());
    const Plan& plan = std::get<Plan>(planned);
    std::vector<std::unique_ptr<ThreadPool>> pools;
    std::vector<std::shared_ptr<const Scene>> scenes;
    for (unsigned i = 0; i < threads; ++i) {
        pools.push_back(std::make_unique<ThreadPool>(1));
        scenes.push_back(prepare(scene, plan, {}, settings, *pools.back()));
    }
    std::atomic<unsigned> stopped = 0;
    const Times times = time_of([&] {
        std::vector<std::jthread> renders;
        for (unsigned i = 0; i < threads; ++i)
            renders.emplace_back([&, i] { stopped += !render(*scenes[i], plan, settings, *pools[i]); });
    });
    if (stopped != 0) throw std::runtime_error("a render was stopped");
    return times;
}

double efficiency_of(const Times& one, const Times& all, unsigned n)
{
    return one.wall_s / (n * all.wall_s);
}

struct Spread {
    explicit Spread(std::vector<double> values)
    {
        std::sort(values.begin(), values.end());
        least = 100 * values.front();
        median = 100 * values[values.size() / 2];
        most = 100 * values.back();
    }
    double least, median, most;
};

void measure(const char* name, RenderSettings settings, int repeats)
{
    ThreadPool pool;
    const unsigned n = pool.size();
    const AssumedScene scene = assume_defaults(ball_of_spheres(), {}, 1);
    const std::size_t items = std::size_t{16} * n;
    std::vector<double> efficiency, of_control, of_apart, ratio, work, busy;
    for (int i = 0; i < repeats; ++i) {
        const Times one = render_times(scene, settings, 1, pool), control_one = control(items, 1, pool),
                    all = render_times(scene, settings, n, pool), control_all = control(items, n, pool),
                    apart = apart_times(scene, settings, n);
        efficiency.push_back(efficiency_of(one, all, n));
        of_control.push_back(efficiency_of(control_one, control_all, n));
        of_apart.push_back(one.wall_s / apart.wall_s);
        ratio.push_back(efficiency.back() / of_apart.back());
        work.push_back(one.cpu_s / all.cpu_s);
        busy.push_back(all.cpu_s / (n * all.wall_s));
    }
    std::printf("%s, %u threads, median of %d (least to most)\n ", name, n, repeats);
    const auto print = [](const char* what, const std::vector<double>& values) {
        const Spread spread(values);
        std::printf("  %s %.1f %% (%.1f to %.1f)", what, spread.median, spread.least, spread.most);
    };
    print("efficiency, goal 97", efficiency);
    print("arithmetic", of_control);
    print("apart", of_apart);
    print("ratio", ratio);
    print("work", work);
    print("busy", busy);
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

void run_tiles(const TilesOptions& options)
{
    RenderSettings everywhere;
    everywhere.image.width_px = everywhere.image.height_px = 256;
    everywhere.quality.samples = 64;
    measure("work everywhere", everywhere, options.repeats);

    // The crop is a single tile.
    RenderSettings one_tile = everywhere;
    one_tile.image.width_px = one_tile.image.height_px = 64;
    one_tile.image.region = PixelRect{24, 24, 16, 16};
    one_tile.quality.samples = 4096;
    measure("one tile holds all the work", one_tile, options.repeats);
}

} // namespace bench
