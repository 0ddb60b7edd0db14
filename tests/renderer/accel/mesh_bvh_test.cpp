#include "renderer/accel/mesh_bvh.h"
#include "tests/renderer/accel/mesh_rays.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace {

using namespace renderer::random_scenes;
using renderer::BvhSplit;
using renderer::Mesh;
using renderer::MeshBvh;
using renderer::MeshHit;
using renderer::Ray;
using renderer::ThreadPool;
using renderer::TriangleRun;
using renderer::Vec3d;
using renderer::mesh_rays::build;
using renderer::mesh_rays::kThinning;
using renderer::mesh_rays::random_ray;
using renderer::mesh_rays::same;
using renderer::mesh_rays::same_bits;
using renderer::mesh_rays::ten_meshes;

TEST(MeshBvh, FindsTheSameHitAsBruteForce)
{
    Random random(1);
    int hits = 0;
    for (const Mesh& mesh : ten_meshes()) {
        const MeshBvh sah = build(mesh), midpoint = build(mesh, BvhSplit::midpoint),
                      spatial = build(mesh, BvhSplit::spatial);
        for (int i = 0; i < 10000 / kThinning; ++i) {
            const Ray ray = random_ray(random, mesh);
            const auto expected = sah.closest_hit_brute_force(ray);
            ASSERT_TRUE(same(sah.closest_hit(ray), expected)) << "sah, ray " << i;
            ASSERT_TRUE(same(midpoint.closest_hit(ray), expected)) << "midpoint, ray " << i;
            ASSERT_TRUE(same(spatial.closest_hit(ray), expected)) << "spatial, ray " << i;
            ASSERT_EQ(sah.any_hit(ray), expected.has_value());
            ASSERT_EQ(midpoint.any_hit(ray), expected.has_value());
            ASSERT_EQ(spatial.any_hit(ray), expected.has_value());
            hits += expected.has_value();
        }
    }
    EXPECT_GT(hits, 100000 / kThinning / 4); // the comparison is not between misses
}

// Shoots `count` rays from inside a closed mesh: at random, at its corners, at points of its edges.
void expect_closed(const Mesh& mesh, Vec3d inside, double room, int count)
{
    Random random(7);
    const MeshBvh bvh = build(mesh);
    for (int i = 0; i < count / kThinning; ++i) {
        const auto& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        const Vec3d a = renderer::to_double(mesh.positions[t[0]]),
                    b = renderer::to_double(mesh.positions[t[1]]);
        const Vec3d origin = inside + random.direction() * (room * random.uniform());
        const double w = random.uniform();
        for (const Vec3d target : {origin + random.direction(), a, a * w + b * (1 - w)}) {
            const Ray ray{origin, target - origin};
            ASSERT_TRUE(bvh.any_hit(ray)) << i;
            ASSERT_TRUE(bvh.closest_hit(ray)) << i;
        }
    }
}

TEST(MeshBvh, LetsNoRayOutOfAClosedMesh)
{
    Random random(71);
    expect_closed(closed_sphere(random, {0, 0, 0}, 1, 6, 16, 16), {0, 0, 0}, 0.2, 100000);
}

TEST(MeshBvh, LetsNoRayOutOfAClosedMeshFarFromTheOrigin)
{
    Random random(72);
    const Vec3d center{148376, 1234, -223423}; // a float there is 1/64 wide
    expect_closed(closed_sphere(random, center, 2, 2, 200, 200), center, 1, 50000);
}

TEST(MeshBvh, FindsTrianglesThatFloatsCannotTellApart)
{
    Random random(73);
    for (const Mesh& mesh : renderer::mesh_rays::fine_meshes()) {
        const MeshBvh bvh = build(mesh);
        const auto& first = mesh.triangles[300]; // of the small ones, strewn within some 1e-2
        const Vec3d near = mesh.position(first[0]);
        int found = 0;
        for (std::uint32_t i = 300; i < 600; ++i) {
            const auto& t = mesh.triangles[i];
            const Vec3d a = mesh.position(t[0]), b = mesh.position(t[1]), c = mesh.position(t[2]);
            const Vec3d normal = normalize(cross(b - a, c - a));
            const double size = length(b - a);
            // From close beside it: one in a hundred has another in between.
            const Ray ray{(a + b + c) / 3.0 + normal * (0.02 * size), -normal};
            const auto hit = bvh.closest_hit(ray);
            ASSERT_TRUE(hit) << i;
            found += hit->primitive == i;
            ASSERT_LE(hit->t, 0.02 * size + 1e-10);
            ASSERT_LT(length(a - near), 1);
        }
        EXPECT_GT(found, 290);
    }
}

TEST(MeshBvh, FindsEachCellOfAPlaneFromAMillionAway)
{
    const Mesh mesh = grid(100, 100);
    const MeshBvh bvh = build(mesh);
    Random random(9);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        Vec3d centroid{};
        for (const std::uint32_t v : mesh.triangles[i])
            centroid = centroid + renderer::to_double(mesh.positions[v]) / 3.0;
        Vec3d away = random.direction();
        away.y = std::abs(away.y) + 0.05;
        Ray ray;
        ray.origin = centroid + away * 1e6;
        ray.direction = centroid - ray.origin;
        const auto hit = bvh.closest_hit(ray);
        ASSERT_TRUE(hit) << i;
        EXPECT_EQ(hit->primitive, i);
    }
}

TEST(MeshBvh, HasNoGapsAlongALattice)
{
    // Heights in whole numbers, rays along an axis at whole and half places: every edge and corner is met
    // exactly.
    Mesh mesh = grid(40, 40);
    Random random(10);
    for (auto& p : mesh.positions)
        p.y = static_cast<float>(random.below(4));
    const MeshBvh bvh = build(mesh);
    for (int i = -38; i <= 38; ++i)
        for (int j = -38; j <= 38; ++j) {
            ASSERT_TRUE(bvh.any_hit(Ray{{i * 0.5, 100, j * 0.5}, {0, -1, 0}})) << i << ' ' << j;
            ASSERT_TRUE(bvh.any_hit(Ray{{i * 0.5, -100, j * 0.5}, {-0.0, 3, 0}})) << i << ' ' << j;
        }
}

TEST(MeshBvh, CountsOneCrossingAtACorner)
{
    Random random(12);
    const Mesh mesh = closed_sphere(random, {0, 0, 0}, 1, 2, 16, 16);
    const MeshBvh bvh = build(mesh);
    for (const auto& corner : mesh.positions) {
        Ray ray{{0, 0, 0}, renderer::to_double(corner)}; // all triangles face the centre
        int crossings = 0;
        while (const auto hit = bvh.closest_hit(ray)) {
            ASSERT_LT(++crossings, 3);
            ray.t_min = hit->t; // what lies within rounding of it is the same crossing
        }
        EXPECT_EQ(crossings, 1);
    }
}

TEST(MeshBvh, PrefersTheLowestNumberAmongEquals)
{
    Mesh mesh = grid(3, 1);
    const auto once = mesh.triangles;
    for (int copy = 0; copy < 5; ++copy)
        mesh.triangles.append(once);
    Random random(15);
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint, BvhSplit::spatial}) {
        const MeshBvh bvh = build(mesh, split);
        for (int i = 0; i < 1000; ++i) {
            const auto hit =
                bvh.closest_hit(Ray{{random.uniform(-.5, .5), 1, random.uniform(-.5, .5)}, {0, -1, 0}});
            ASSERT_TRUE(hit);
            EXPECT_LT(hit->primitive, once.size());
        }
    }
}

TEST(MeshBvh, KeepsItsHitsUnderEverySignOfZero)
{
    // Corners on a lattice and rays along its lines: origins lie on the planes of boxes, where 0 * infinity
    // lurks.
    Random random(17);
    Mesh mesh;
    const auto place = [&] { return static_cast<double>(random.below(5)) - 2; };
    for (std::uint32_t i = 0; i < 120; ++i)
        mesh.positions.push_back(renderer::to_float({place(), place(), place()}));
    for (std::uint32_t i = 0; i < 40; ++i)
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    const MeshBvh bvh = build(mesh), midpoint = build(mesh, BvhSplit::midpoint),
                  spatial = build(mesh, BvhSplit::spatial);
    const double steps[] = {0.0, -0.0, 0.0, -0.0, 1, -1};
    int hits = 0;
    for (int i = 0; i < 1000000 / kThinning; ++i) {
        const Ray ray{{place(), place(), place()},
                      {steps[random.below(6)], steps[random.below(6)], steps[random.below(6)]}};
        const auto expected = bvh.closest_hit_brute_force(ray);
        ASSERT_TRUE(same(bvh.closest_hit(ray), expected)) << i;
        ASSERT_TRUE(same(midpoint.closest_hit(ray), expected)) << i;
        ASSERT_TRUE(same(spatial.closest_hit(ray), expected)) << i;
        hits += expected.has_value();
    }
    EXPECT_GT(hits, 100000 / kThinning);
}

TEST(MeshBvh, IsMissedByRaysThatAreNoRays)
{
    const MeshBvh bvh = build(grid(10, 10));
    const Ray good{{0.1, 5, 0.1}, {0.1, -1, 0.1}};
    ASSERT_TRUE(bvh.any_hit(good));
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, inf, -inf})
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Ray ray = good;
            ray.origin[axis] = bad;
            EXPECT_FALSE(bvh.closest_hit(ray));
            EXPECT_FALSE(bvh.any_hit(ray));
            ray = good;
            ray.direction[axis] = bad;
            EXPECT_FALSE(bvh.closest_hit(ray));
            EXPECT_FALSE(bvh.any_hit(ray));
        }
    for (const auto& [t_min, t_max] :
         {std::pair{nan, inf}, {0., nan}, {inf, inf}, {0., -inf}, {5., 5.}, {0., 0.}})
        EXPECT_FALSE(bvh.any_hit(Ray{good.origin, good.direction, t_min, t_max})) << t_min << ' ' << t_max;
    EXPECT_FALSE(bvh.any_hit(Ray{good.origin, {0, 0, 0}}));
    EXPECT_FALSE(bvh.any_hit(Ray{good.origin, {0, -0.0, 0}}));
}

TEST(MeshBvh, TakesDirectionsOfAnyLength)
{
    Random random(24);
    const Mesh mesh = soup(random, 200, 1, 0.5);
    const MeshBvh bvh = build(mesh);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        Ray ray{random.direction() * 3.0, random.direction()};
        ray.direction = random.in_box({-1, -1, -1}, {1, 1, 1}) - ray.origin;
        const auto expected = bvh.closest_hit(ray);
        for (const double scale : {0x1p-996, 0x1p-40, 0x1p40, 0x1p996}) {
            const auto hit = bvh.closest_hit({ray.origin, ray.direction * scale});
            ASSERT_EQ(hit.has_value(), expected.has_value());
            if (!hit) continue;
            ++hits;
            EXPECT_EQ(hit->primitive, expected->primitive);
            EXPECT_TRUE(same_bits(hit->t * scale, expected->t)) << "powers of two change nothing";
        }
    }
    EXPECT_GT(hits, 1000);
}

// Sizes whose products leave float's range, or that are no longer normal numbers.
TEST(MeshBvh, TakesMeshesOfAnySize)
{
    Random random(25);
    const Mesh unit = soup(random, 300, 1, 0.5);
    const MeshBvh plain = build(unit);
    for (const int exponent : {-90, -60, 60, 120}) {
        Mesh mesh = unit;
        for (auto& p : mesh.positions)
            p = p * std::ldexp(1.0f, exponent);
        const MeshBvh bvh = build(mesh), midpoint = build(mesh, BvhSplit::midpoint),
                      spatial = build(mesh, BvhSplit::spatial);
        const double scale = std::ldexp(1.0, exponent);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const Ray ray = random_ray(random, unit);
            const Ray scaled{ray.origin * scale, ray.direction * scale, ray.t_min, ray.t_max};
            const auto hit = bvh.closest_hit(scaled);
            ASSERT_TRUE(same(hit, bvh.closest_hit_brute_force(scaled)));
            ASSERT_TRUE(same(hit, midpoint.closest_hit(scaled)));
            ASSERT_TRUE(same(hit, spatial.closest_hit(scaled)));
            ASSERT_TRUE(same(hit, plain.closest_hit(ray))) << "a scale by a power of two changes nothing";
            hits += hit.has_value();
        }
        EXPECT_GT(hits, 500);
    }
    Mesh tiny = unit; // 1e-40: every coordinate below the smallest normal float
    for (auto& p : tiny.positions)
        p = p * 1e-20f * 1e-20f;
    const MeshBvh bvh = build(tiny);
    for (int i = 0; i < 2000; ++i) {
        const Ray ray = random_ray(random, tiny);
        ASSERT_TRUE(same(bvh.closest_hit(ray), bvh.closest_hit_brute_force(ray)));
    }
}

TEST(MeshBvh, CountsTrianglesWithoutAreaAndNeverHitsThem)
{
    Mesh mesh = grid(4, 4);
    mesh.triangles.push_back({0, 0, 0});
    mesh.triangles.push_back({0, 1, 2}); // on a line
    mesh.triangles.push_back({3, 7, 3});
    const MeshBvh bvh = build(mesh);
    EXPECT_EQ(bvh.degenerate_triangles(), 3u);
    Mesh nothing = mesh;
    nothing.triangles = {{0, 0, 0}, {1, 1, 2}};
    const MeshBvh empty = build(nothing);
    EXPECT_EQ(empty.degenerate_triangles(), 2u);
    EXPECT_TRUE(empty.bounds().empty());
    EXPECT_FALSE(empty.any_hit(Ray{{0, 1, 0}, {0, -1, 0}}));
    EXPECT_FALSE(empty.closest_hit(Ray{{-2, 1, -2}, {0, -1, 0}}));
}

TEST(MeshBvh, FindsNothingOutsideTheRange)
{
    const MeshBvh bvh = build(grid(10, 10));
    const Ray ray{{0.2, 5, 0.3}, {0, -2, 0}};
    const double t = bvh.closest_hit(ray)->t;
    ASSERT_NEAR(t, 2.5, 1e-15);
    EXPECT_FALSE(bvh.any_hit({ray.origin, ray.direction, 0, t})) << "open at its end";
    EXPECT_TRUE(bvh.any_hit({ray.origin, ray.direction, 0, std::nextafter(t, 3)}));
    EXPECT_FALSE(bvh.any_hit({ray.origin, ray.direction, t, 9})) << "and at its start";
    EXPECT_TRUE(bvh.any_hit({ray.origin, ray.direction, t - 1e-13, 9}));
    EXPECT_TRUE(bvh.any_hit({ray.origin, ray.direction * -1.0, -3, 9}))
        << "a range may begin behind the origin";
}

} // namespace
