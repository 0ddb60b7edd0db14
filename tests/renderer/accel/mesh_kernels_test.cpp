// Every kernel that this processor can run, rays one by one and in runs: the same hits to the last bit. Fans:
// mesh_kernels_fans_test.cpp.
#include "renderer/accel/mesh_kernels.h"
#include "tests/renderer/accel/mesh_kernel_test.h"

#include <algorithm>
#include <limits>
#include <span>
#include <string>

namespace {

using namespace renderer;
using namespace renderer::mesh_rays;

class EveryMeshKernel : public MeshKernelTest {};

INSTANTIATE_TEST_SUITE_P(All,
                         EveryMeshKernel,
                         testing::ValuesIn(all_mesh_kernels().begin(), all_mesh_kernels().end()),
                         [](const auto& suite) { return std::string(suite.param.name); });

// A beam as a camera or a light of no size sends it: from about one point, to about one place.
std::vector<Ray> beam(Random& random, const Mesh& mesh, std::size_t count)
{
    const Ray middle = random_ray(random, mesh);
    const double width = std::pow(10, random.uniform(-6, -0.5)) * length(middle.direction);
    const double spread = random.below(3) == 0 ? width : 0; // parallel, or from one point
    std::vector<Ray> rays(count, middle);
    for (Ray& ray : rays) {
        ray.origin = ray.origin + random.direction() * spread;
        ray.direction = middle.direction + random.direction() * width;
        if (random.below(16) == 0) ray.direction[random.below(3)] = 0;
        if (random.below(16) == 0) ray.t_max = random.uniform(0, 2);
    }
    return rays;
}

TEST_P(EveryMeshKernel, FollowsBeamsAsBruteForceWould)
{
    Random random(31);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (int i = 0; i < 40 / kThinning; ++i)
            expect_as_brute_force(bvh, beam(random, mesh, kRun));
    }
    EXPECT_GT(hits_, rays_ / 5);
}

TEST_P(EveryMeshKernel, FollowsRaysThatHaveNothingInCommon)
{
    Random random(32);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (int i = 0; i < 120 / kThinning; ++i) {
            std::vector<Ray> rays;
            while (rays.size() < 1 + random.below(kRun))
                rays.push_back(random_ray(random, mesh));
            expect_as_brute_force(bvh, rays);
        }
    }
    EXPECT_GT(hits_, rays_ / 5);
}

TEST_P(EveryMeshKernel, FollowsRaysAmongCornersThatAreMoreThanFloats)
{
    Random random(36);
    for (const Mesh& mesh : fine_meshes()) {
        ASSERT_FALSE(mesh.residuals.empty());
        const MeshBvh bvh = build(mesh);
        for (int i = 0; i < 200 / kThinning; ++i) {
            expect_as_brute_force(bvh, beam(random, mesh, kRun));
            std::vector<Ray> rays;
            while (rays.size() < 1 + random.below(kRun))
                rays.push_back(random_ray(random, mesh));
            expect_as_brute_force(bvh, rays);
        }
    }
    EXPECT_GT(hits_, rays_ / 5);
}

TEST_P(EveryMeshKernel, FollowsAnyNumberOfRaysApart)
{
    Random random(36);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 700u}) {
            std::vector<Ray> rays(count);
            for (Ray& ray : rays)
                ray = random_ray(random, mesh);
            expect_apart_as_brute_force(bvh, rays);
        }
    }
    EXPECT_GT(hits_, rays_ / 5);
}

// As bounces and shadow rays do: from just above the surface, and from on it.
TEST_P(EveryMeshKernel, FollowsRaysThatStartAtTheSurface)
{
    Random random(37);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        std::vector<Ray> rays(2000 / kThinning);
        for (Ray& ray : rays) {
            const Triangle& v =
                mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
            const Vec3d a = to_double(mesh.positions[v[0]]), b = to_double(mesh.positions[v[1]]),
                        c = to_double(mesh.positions[v[2]]);
            const double w = random.uniform(), above = std::pow(10, random.uniform(-9, -1));
            const Vec3d at = (a * w + b * (1 - w)) * 0.5 + c * 0.5;
            ray.origin = random.below(4) == 0 ? at : at + cross(b - a, c - a) * above;
            ray.direction = random.direction();
            if (random.below(4) == 0) ray.t_max = length(b - a) * random.uniform();
        }
        expect_apart_as_brute_force(bvh, rays);
    }
    EXPECT_GT(hits_, rays_ / 20);
}

TEST_P(EveryMeshKernel, PassesOverRaysThatAreNoRays)
{
    Random random(33);
    const Mesh mesh = soup(random, 2000, 1, 0.3);
    const MeshBvh bvh = build(mesh);
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 300; ++i) {
        std::vector<Ray> rays = beam(random, mesh, kRun);
        for (Ray& ray : rays)
            switch (random.below(12)) {
            case 0:
                ray.origin[random.below(3)] = nan;
                break;
            case 1:
                ray.direction[random.below(3)] = nan;
                break;
            case 2:
                ray.origin[random.below(3)] = infinity;
                break;
            case 3:
                ray.direction[random.below(3)] = -infinity;
                break;
            case 4:
                ray.t_min = nan;
                break;
            case 5:
                ray.t_max = nan;
                break;
            case 6:
                ray.direction = {};
                break;
            case 7:
                ray.t_max = ray.t_min;
                break;
            default:
                break;
            }
        expect_as_brute_force(bvh, rays);
    }
    EXPECT_GT(hits_, 100);
}

TEST(MeshKernels, HaveAPortableOneToFallBackOn)
{
    const auto kernels = all_mesh_kernels();
    ASSERT_FALSE(kernels.empty());
    EXPECT_STREQ(kernels.front().name, mesh_kernels().name);
    for (std::size_t i = 0; i < kernels.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_STRNE(kernels[i].name, kernels[j].name);
}

} // namespace
