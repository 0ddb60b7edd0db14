// Rays through one point, on every kernel that this processor can run: the same hits to the last bit as one by one.
#include "tests/renderer/accel/mesh_kernel_test.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace renderer;
using namespace renderer::mesh_rays;

class FansOfEveryMeshKernel : public MeshKernelTest {
protected:
    // Whole ones, and some of fewer rays.
    void expect_fans_as_brute_force(std::uint64_t seed,
                                    std::vector<Ray> (*fan)(Random&, const Mesh&, std::size_t count))
    {
        Random random(seed);
        for (const Mesh& mesh : ten_meshes()) {
            const MeshBvh bvh = build(mesh);
            for (int i = 0; i < 60 / kThinning; ++i)
                expect_as_brute_force(
                    bvh, fan(random, mesh, random.below(4) == 0 ? 2 + random.below(kRun - 1) : kRun));
        }
        EXPECT_GT(hits_, rays_ / 5);
    }
};

INSTANTIATE_TEST_SUITE_P(All,
                         FansOfEveryMeshKernel,
                         testing::ValuesIn(all_mesh_kernels().begin(), all_mesh_kernels().end()),
                         [](const auto& suite) { return std::string(suite.param.name); });

// A point that rays of a fan are aimed at, or come from: on a corner, an edge or a face of the mesh, or about it.
Vec3d place_on(Random& random, const Mesh& mesh)
{
    const Triangle& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const Vec3d a = to_double(mesh.positions[t[0]]), b = to_double(mesh.positions[t[1]]),
                c = to_double(mesh.positions[t[2]]);
    const double u = random.uniform(), v = random.uniform() * (1 - u);
    switch (random.below(4)) {
    case 0:
        return a;
    case 1:
        return a * u + b * (1 - u);
    default:
        return a * u + b * v + c * (1 - u - v);
    }
}

Vec3d about(Random& random, const Mesh& mesh, double farthest)
{
    const auto box = mesh.bounds();
    const Vec3d low = to_double(box.lower), high = to_double(box.upper);
    return (low + high) * 0.5 + random.direction() * (length(high - low) * random.uniform(0, farthest));
}

// In an order in which neighbours are alike, as those of pixels are: what bounds some is narrower than what bounds all.
void put_neighbours_together(std::vector<Ray>& rays, std::size_t axis)
{
    std::ranges::sort(
        rays, {}, [axis](const Ray& ray) { return ray.direction[axis] / max_component(abs(ray.direction)); });
}

// Rays from one point, as a pinhole camera sends them: at places near each other, corners and edges among them.
std::vector<Ray> camera_fan(Random& random, const Mesh& mesh, std::size_t count)
{
    const Vec3d eye = random.below(8) == 0 ? place_on(random, mesh) : about(random, mesh, 3);
    const Vec3d middle = place_on(random, mesh);
    const double width = std::pow(10, random.uniform(-6, -0.5)) * length(middle - eye);
    const double speed = random.below(4) == 0 ? std::pow(10, random.uniform(-9, 9)) : 1;
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        const Vec3d target = random.below(4) == 0 ? middle : middle + random.direction() * width;
        ray = {eye, (target - eye) * speed};
        if (random.below(64) == 0) ray.direction[random.below(3)] = 0;
        if (random.below(16) == 0) ray.t_max = random.uniform(0, 2) / speed;
        if (random.below(16) == 0) ray.t_min = random.uniform(0, 1) / speed;
    }
    if (random.below(2) == 0) put_neighbours_together(rays, random.below(3));
    return rays;
}

// Rays from surfaces to one point, by its distance or as the whole way.
std::vector<Ray> light_fan(Random& random, const Mesh& mesh, std::size_t count)
{
    const Vec3d light = random.below(8) == 0 ? place_on(random, mesh) : about(random, mesh, 2);
    const Vec3d middle = place_on(random, mesh);
    const double width = std::pow(10, random.uniform(-6, -0.5)) * length(middle - light);
    const bool floats = random.below(2) != 0, unit = random.below(2) != 0;
    const double stand_off = random.below(2) * std::pow(10, random.uniform(-12, -2));
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        Vec3d from = random.below(3) == 0 ? place_on(random, mesh) : middle + random.direction() * width;
        from = from + (light - from) * stand_off;
        if (floats) from = to_double(to_float(from));
        ray = {from, light - from, 0, 1};
        if (floats) ray.direction = to_double(to_float(ray.direction));
        if (!unit) continue;
        const double distance = length(ray.direction);
        ray = {from, ray.direction / distance, 0, distance * (1 - 0x1p-20)};
    }
    if (random.below(2) == 0) put_neighbours_together(rays, random.below(3));
    return rays;
}

TEST_P(FansOfEveryMeshKernel, FollowsFansOfACameraAsBruteForceWould)
{
    expect_fans_as_brute_force(36, camera_fan);
}

TEST_P(FansOfEveryMeshKernel, FollowsFansToALightAsBruteForceWould)
{
    expect_fans_as_brute_force(37, light_fan);
}

// Rays to a light from a few places in turn, so that neighbours have little in common: from one side of the light or
// from several.
std::vector<Ray> scattered_light_fan(Random& random, const Mesh& mesh, const Vec3d& light)
{
    const unsigned places = 2 + random.below(5);
    Vec3d place[6];
    for (unsigned i = 0; i < places; ++i)
        place[i] = random.below(2) == 0 ? about(random, mesh, 2) : place_on(random, mesh);
    const double width = std::pow(10, random.uniform(-4, -1));
    std::vector<Ray> rays(random.below(4) == 0 ? 8 + random.below(kRun - 8) : kRun);
    for (Ray& ray : rays) {
        const Vec3d& at = place[random.below(places)];
        const Vec3d from = at + random.direction() * (width * length(at - light));
        ray = {from, light - from, 0, 1 - 0x1p-20};
    }
    return rays;
}

TEST_P(FansOfEveryMeshKernel, FollowsRaysToALightFromSeveralPlaces)
{
    Random random(42);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (int i = 0; i < 60 / kThinning; ++i)
            expect_as_brute_force(bvh, scattered_light_fan(random, mesh, about(random, mesh, 2)));
    }
    EXPECT_GT(hits_, rays_ / 5);
}

// What hid the light from the last fan is asked first, and may hide it from the next one, from a part of it or not at
// all; or it was of a mesh that is gone, and another one is in its place.
TEST_P(FansOfEveryMeshKernel, FollowsFansToALightThatWasHidden)
{
    Random random(43);
    std::optional<MeshBvh> bvh;
    for (const std::uint32_t cells : {30u, 3u, 12u, 1u}) {
        const Mesh wall = grid(cells, 10);
        bvh.reset();
        bvh = build(wall);
        const Vec3d low = to_double(bvh->bounds().lower), high = to_double(bvh->bounds().upper);
        const double across = length(high - low);
        const Vec3d middle = (low + high) * 0.5, light = middle + Vec3d{0, across, 0};
        for (int i = 0; i < 20; ++i) {
            const Vec3d below = middle + Vec3d{across * 0.07 * i, -0.3 * across, 0};
            std::vector<Ray> rays(kRun);
            for (Ray& ray : rays) {
                const Vec3d from = below + random.direction() * (0.05 * across);
                ray = {from, light - from, 0, 1 - 0x1p-20};
            }
            expect_as_brute_force(*bvh, rays);
        }
    }
    EXPECT_GT(hits_, rays_ / 5);
    EXPECT_LT(hits_, rays_ - rays_ / 10);
}

// Along most rays two axes are as much as each other, and which of them a ray counts as running along may not depend on
// the first of the fan, along which one is a little more.
TEST_P(FansOfEveryMeshKernel, FollowsFansAlongTheDiagonalsOfAxes)
{
    Random random(41);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (std::size_t across = 0; across < 3; ++across) {
            const Vec3d target = place_on(random, mesh);
            Vec3d along{random.below(2) == 0 ? 1.0 : -1.0, 1, random.below(2) == 0 ? 1.0 : -1.0};
            along[across] = 0;
            const double distance = length(to_double(mesh.bounds().extent())) * random.uniform(0.1, 3);
            const Vec3d eye = target - along * distance;
            std::vector<Ray> out(kRun), back(kRun);
            for (std::size_t i = 0; i < kRun; ++i) {
                Vec3d direction = along * random.uniform(0.5, 2);
                direction[across] = random.uniform(-0.2, 0.2);
                if (i == 0) direction[(across + 1 + random.below(2)) % 3] *= 1.001;
                out[i] = {eye, direction};
                const double far = distance * 2;
                back[i] = {eye + direction * far, -direction, 0, far};
            }
            expect_as_brute_force(bvh, out);
            expect_as_brute_force(bvh, back);
        }
    }
    EXPECT_GT(hits_, 0u);
}

// Sparse rays over small triangles: together they meet more leaves than a fan may, and are followed in another way.
TEST_P(FansOfEveryMeshKernel, FollowsFansWhoseRaysStandFarApart)
{
    Random random(40);
    const Mesh mesh = grid(100, 100);
    const MeshBvh bvh = build(mesh);
    const Bounds3d box{to_double(bvh.bounds().lower), to_double(bvh.bounds().upper)};
    const Vec3d eye = box.center() + Vec3d{0, 2 * length(box.extent()), 0};
    for (int i = 0; i < 3; ++i) {
        std::vector<Ray> rays;
        while (rays.size() < kRun)
            rays.push_back({eye, random.in_box(box.lower, box.upper) - eye});
        expect_as_brute_force(bvh, rays);
    }
    EXPECT_GT(hits_, rays_ / 2);
}

TEST_P(FansOfEveryMeshKernel, AreFollowedAmongCornersThatAreMoreThanFloats)
{
    Random random(44);
    for (const Mesh& mesh : fine_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (int i = 0; i < 50 / kThinning; ++i) {
            expect_as_brute_force(bvh, camera_fan(random, mesh, kRun));
            expect_as_brute_force(bvh, light_fan(random, mesh, kRun));
        }
    }
    EXPECT_GT(hits_, rays_ / 5);
}

} // namespace
