#include "tests/bench/bench_instances.h"

#include "tests/bench/stopwatch.h"
#include "tests/support/random_numbers.h"

#include <cmath>

namespace bench {

using namespace renderer;

std::vector<Instance> instances_of(const PreparedMesh& mesh, std::uint32_t count)
{
    const auto side = static_cast<std::uint32_t>(std::ceil(std::cbrt(count)));
    std::vector<Instance> instances;
    instances.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3d at{kCellSize * (i % side), kCellSize * (i / side % side), kCellSize * (i / side / side)};
        const Affine3 turned = Affine3::rotate_deg(static_cast<double>(i * 37 % 360), {1, 2, 3});
        instances.push_back(
            Instance::place(MeshGeometry{&mesh_of(mesh), bvh_of(mesh)}, Affine3::translate(at) * turned)
                .value());
    }
    return instances;
}

double million_rays_a_second(const InstanceTree& tree)
{
    constexpr unsigned kRuns = 20000, kRays = 16;
    const Vec3d low = tree.bounds().lower, extent = tree.bounds().extent();
    tests::RandomNumbers random(1);
    Ray rays[kRays];
    SceneHit hits[kRays];
    double seconds = 0;
    for (unsigned run = 0; run < kRuns; ++run) {
        for (Ray& ray : rays)
            ray = Ray{low + Vec3d{extent.x * random.between(0, 1),
                                  extent.y * random.between(0, 1),
                                  extent.z * random.between(0, 1)},
                      {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}};
        const Stopwatch watch(CLOCK_THREAD_CPUTIME_ID);
        tree.closest_hits(rays, hits);
        seconds += watch.spent().cpu_s;
    }
    return kRuns * kRays / seconds / 1e6;
}

} // namespace bench
