// heliograph-bench frames: the tree over the objects of an animation, refitted from frame to frame as the renderer does
// it, beside the same one built anew for each.
#include "renderer/accel/instance_tree.h"
#include "renderer/accel/prepared_mesh.h"
#include "tests/bench/bench_instances.h"
#include "tests/bench/commands.h"
#include "tests/bench/spread.h"
#include "tests/bench/stopwatch.h"
#include "tests/bench/terrain.h"
#include "tests/support/random_numbers.h"

#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace bench {

namespace {

using namespace renderer;

enum class Motion { still, some, all, burst };
struct NamedMotion {
    Motion motion;
    const char* name;
};
constexpr NamedMotion kMotions[]{{Motion::still, "only the camera moves"},
                                 {Motion::some, "a tenth of them, a tenth of a cell a frame"},
                                 {Motion::all, "all, a tenth of a cell a frame"},
                                 {Motion::burst, "all away from one spot"}};

// The instances where they are in frame `frame`.
std::vector<Instance> moved(const std::vector<Instance>& still, Motion motion, int frame, int frames)
{
    tests::RandomNumbers random(7);
    const double time = static_cast<double>(frame) / frames;
    const Vec3d middle = still[still.size() / 2].world_bounds().center();
    std::vector<Instance> there;
    there.reserve(still.size());
    for (const Instance& instance : still) {
        const Vec3d way{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
        const bool moves = motion != Motion::some || random.between(0, 1) < 0.1;
        Vec3d by{};
        if (motion == Motion::burst)
            by = (middle - instance.world_bounds().center()) * (1 - time);
        else if (motion != Motion::still && moves)
            by = way * (0.1 * kCellSize * frame);
        there.push_back(
            Instance::place(instance.geometry(), Affine3::translate(by) * instance.world_from_object())
                .value());
    }
    return there;
}

bool same_hits(const InstanceTree& a, const InstanceTree& b)
{
    tests::RandomNumbers random(3);
    const Vec3d low = a.bounds().lower, extent = a.bounds().extent();
    for (int i = 0; i < 10000; ++i) {
        const Ray ray{low + Vec3d{extent.x * random.between(0, 1),
                                  extent.y * random.between(0, 1),
                                  extent.z * random.between(0, 1)},
                      {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}};
        const auto hit = a.closest_hit(ray), other = b.closest_hit(ray);
        if (hit.has_value() != other.has_value()) return false;
        if (hit &&
            (hit->t != other->t || hit->instance != other->instance || hit->primitive != other->primitive))
            return false;
    }
    return true;
}

struct Timed {
    InstanceTree tree;
    double cpu_ms;
};

Timed timed_tree(std::vector<Instance> instances, ThreadPool& pool, const EarlierFrames& earlier)
{
    const Stopwatch watch(CLOCK_PROCESS_CPUTIME_ID);
    InstanceTree tree(std::move(instances), BvhSplit::sah, pool, std::nullopt, earlier);
    return {std::move(tree), 1e3 * watch.spent().cpu_s};
}

void measure(const std::vector<Instance>& still, const NamedMotion& motion, const FramesOptions& options)
{
    ThreadPool pool(options.threads);
    BvhTopologyCache trees;
    int refitted = 0;
    std::vector<double> anew_ms, frame_ms, refitted_ms, speed;
    for (int frame = 0; frame <= options.frames; ++frame) {
        const std::vector<Instance> instances = moved(still, motion.motion, frame, options.frames);
        const Timed anew = timed_tree(instances, pool, {});
        const Timed kept = timed_tree(instances, pool, {&trees, options.rays});
        if (!same_hits(anew.tree, kept.tree)) throw std::runtime_error("a refitted tree finds other hits");
        if (frame == 0) continue; // nothing is there yet
        anew_ms.push_back(anew.cpu_ms);
        frame_ms.push_back(kept.cpu_ms);
        if (kept.tree.upper_level() != UpperLevel::refitted) continue;
        ++refitted;
        refitted_ms.push_back(kept.cpu_ms);
        const double before = million_rays_a_second(anew.tree), now = million_rays_a_second(kept.tree);
        speed.push_back(2 * now / (before + million_rays_a_second(anew.tree)));
    }
    std::printf("%8zu  %-44s %3d of %d ", still.size(), motion.name, refitted, options.frames);
    std::printf("%9.3f %9.3f", spread_of(anew_ms).median, spread_of(frame_ms).median);
    if (refitted != 0) {
        const Spread s = spread_of(speed);
        std::printf(
            " %9.3f %9.3f (%.3f to %.3f)", spread_of(refitted_ms).median, s.median, s.least, s.greatest);
    }
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

void run_frames(const FramesOptions& options)
{
    ThreadPool pool;
    const auto mesh = prepare_mesh(terrain_mesh(512), MeshTree::wide_sah, pool);
    std::printf("%8s  %-44s %-9s %9s %9s %9s %9s\n",
                "objects",
                "motion",
                "refitted",
                "anew ms",
                "frame ms",
                "refit ms",
                "rays/s, refitted / anew");
    for (const std::uint32_t count : options.objects) {
        const std::vector<Instance> still = instances_of(*mesh, count);
        for (const NamedMotion& motion : kMotions)
            measure(still, motion, options);
    }
}

} // namespace bench
