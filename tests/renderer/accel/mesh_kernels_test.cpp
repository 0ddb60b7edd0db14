// Every kernel that this processor can run, rays one by one and in runs: the same hits to the last bit.
#include "renderer/accel/mesh_kernels.h"
#include "tests/renderer/accel/mesh_rays.h"

#include <algorithm>
#include <limits>
#include <span>
#include <string>

namespace {

using namespace renderer;
using namespace renderer::mesh_rays;

constexpr unsigned kRun = MeshKernels::kMostRays;

class EveryMeshKernel : public testing::TestWithParam<MeshKernels> {
protected:
    // The run's answers are those of its rays, one by one, from all triangles in turn.
    void expect_as_brute_force(const MeshBvh& bvh, std::span<const Ray> rays)
    {
        struct Answer {
            MeshHit hits[kRun];
            std::uint64_t found = 0, met = 0;
        };
        Answer answers[2]; // walks together, and what is done where they have not paid
        for (const bool lost : {false, true}) {
            bvh.fans() = {};
            for (int i = 0; i < 1000 && lost; ++i) {
                bvh.fans().nearest.tell(false);
                bvh.fans().any.tell(false);
            }
            Answer& answer = answers[lost ? 1 : 0];
            answer.found = bvh.closest_hits(rays, answer.hits, GetParam());
            answer.met = bvh.any_hits(rays, GetParam());
        }
        expect_apart_as_brute_force(bvh, rays);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto expected = bvh.closest_hit_brute_force(rays[i]);
            for (const Answer& answer : answers) {
                const bool hit = (answer.found >> i & 1) != 0;
                ASSERT_TRUE(same(hit ? std::optional(answer.hits[i]) : std::nullopt, expected))
                    << "ray " << i << " of a run";
                ASSERT_EQ((answer.met >> i & 1) != 0, expected.has_value()) << "ray " << i << " of a run";
            }
            ASSERT_TRUE(same(bvh.closest_hit(rays[i], GetParam()), expected)) << "ray " << i << " alone";
            ASSERT_EQ(bvh.any_hit(rays[i], GetParam()), expected.has_value()) << "ray " << i << " alone";
            hits_ += expected.has_value();
            ++rays_;
        }
        for (const Answer& answer : answers)
            ASSERT_EQ((answer.found | answer.met) >> (rays.size() - 1) >> 1, std::uint64_t{0})
                << "rays that are not there have hit";
    }

    void expect_apart_as_brute_force(const MeshBvh& bvh, std::span<const Ray> rays)
    {
        std::vector<MeshHit> hits(rays.size()), met(rays.size());
        bvh.closest_hits_apart(rays, hits, GetParam());
        bvh.any_hits_apart(rays, met, GetParam());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const auto expected = bvh.closest_hit_brute_force(rays[i]);
            const bool hit = hits[i].primitive != TriangleBlock::kNone;
            ASSERT_TRUE(same(hit ? std::optional(hits[i]) : std::nullopt, expected))
                << "ray " << i << " apart";
            ASSERT_EQ(met[i].primitive != TriangleBlock::kNone, expected.has_value())
                << "ray " << i << " apart";
            hits_ += hit;
            ++rays_;
        }
    }

    int hits_ = 0, rays_ = 0;
};

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

TEST_P(EveryMeshKernel, FollowsFansOfACameraAsBruteForceWould)
{
    Random random(36);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (int i = 0; i < 60 / kThinning; ++i)
            expect_as_brute_force(
                bvh, camera_fan(random, mesh, random.below(4) == 0 ? 2 + random.below(kRun - 1) : kRun));
    }
    EXPECT_GT(hits_, rays_ / 5);
}

TEST_P(EveryMeshKernel, FollowsFansToALightAsBruteForceWould)
{
    Random random(37);
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh bvh = build(mesh);
        for (int i = 0; i < 60 / kThinning; ++i)
            expect_as_brute_force(
                bvh, light_fan(random, mesh, random.below(4) == 0 ? 2 + random.below(kRun - 1) : kRun));
    }
    EXPECT_GT(hits_, rays_ / 5);
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

TEST_P(EveryMeshKernel, FollowsRaysToALightFromSeveralPlaces)
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
TEST_P(EveryMeshKernel, FollowsFansToALightThatWasHidden)
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
TEST_P(EveryMeshKernel, FollowsFansAlongTheDiagonalsOfAxes)
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
            if (i % 4 != 0) continue;
            expect_as_brute_force(bvh, camera_fan(random, mesh, kRun));
            expect_as_brute_force(bvh, light_fan(random, mesh, kRun));
        }
    }
    EXPECT_GT(hits_, rays_ / 5);
}

// Sparse rays over small triangles: together they meet more leaves than a fan may, and are followed in another way.
TEST_P(EveryMeshKernel, FollowsFansWhoseRaysStandFarApart)
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
