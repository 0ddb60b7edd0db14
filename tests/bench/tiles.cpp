// heliograph-bench tiles: parallel efficiency of the tile loop, t(1) / (n t(n)), in one run: for a picture
// with work everywhere, and for one whose every costly pixel lies in a single 16x16 tile.
#include "renderer/math/transcendental.h"
#include "renderer/render.h"
#include "tests/bench/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>

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

double render_seconds(const AssumedScene& scene, RenderSettings settings, unsigned threads, ThreadPool& pool)
{
    settings.acceleration.threads = threads;
    const std::variant<Plan, std::vector<Fault>> planned = make_plan(scene, {}, settings, Limits::none());
    const Plan& plan = std::get<Plan>(planned);
    const std::shared_ptr<const Scene> ready = prepare(scene, plan, {}, settings, pool);
    const auto start = std::chrono::steady_clock::now();
    if (!render(*ready, plan, settings, pool)) throw std::runtime_error("the render was stopped");
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(const char* name, RenderSettings settings, int repeats)
{
    ThreadPool pool;
    const unsigned n = pool.size();
    const AssumedScene scene = assume_defaults(ball_of_spheres(), {}, 1);
    std::vector<double> efficiency;
    for (int i = 0; i < repeats; ++i) {
        const double one = render_seconds(scene, settings, 1, pool),
                     all = render_seconds(scene, settings, n, pool);
        efficiency.push_back(one / (n * all));
    }
    std::sort(efficiency.begin(), efficiency.end());
    std::printf("%-28s %u threads: efficiency %.1f %% (median of %d; %.1f to %.1f)   goal: 97 %%\n",
                name,
                n,
                100 * efficiency[efficiency.size() / 2],
                repeats,
                100 * efficiency.front(),
                100 * efficiency.back());
}

void run(int repeats)
{
    RenderSettings everywhere;
    everywhere.image.width_px = everywhere.image.height_px = 256;
    everywhere.quality.samples = 64;
    measure("work everywhere", everywhere, repeats);

    // The crop is a single tile.
    RenderSettings one_tile = everywhere;
    one_tile.image.width_px = one_tile.image.height_px = 64;
    one_tile.image.region = PixelRect{24, 24, 16, 16};
    one_tile.quality.samples = 4096;
    measure("one tile holds all the work", one_tile, repeats);
}

} // namespace

void add_tiles(CLI::App& app)
{
    CLI::App* const command = app.add_subcommand("tiles", "parallel efficiency of the tile loop");
    const auto repeats = std::make_shared<int>(7);
    command->add_option("--repeats", *repeats, "pairs of renders")->capture_default_str();
    command->callback([repeats] { run(*repeats); });
}

} // namespace bench
