#include "renderer/accel/mesh_bvh.h"
#include "renderer/accel/spatial_bvh.h"
#include "renderer/accel/triangle_items.h"
#include "tests/renderer/accel/mesh_rays.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/renderer/accel/random_trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <vector>

namespace {

using namespace renderer;
using mesh_rays::build;
using mesh_rays::same;
using random_scenes::Random;
using random_trees::half_area_of;

// Long splinters in all directions among a multitude of crumbs.
Mesh straw(std::uint32_t splinters, std::uint32_t crumbs)
{
    Random random(41);
    Mesh mesh;
    const auto add = [&](Vec3d at, Vec3d along, double width) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(to_float(at));
        mesh.positions.push_back(to_float(at + along));
        mesh.positions.push_back(to_float(at + along + random.direction() * width));
        mesh.triangles.push_back({first, first + 1, first + 2});
    };
    for (std::uint32_t i = 0; i < splinters; ++i)
        add(random.in_box({-1, -1, -1}, {1, 1, 1}), random.direction() * 1.5, 0.02);
    for (std::uint32_t i = 0; i < crumbs; ++i)
        add(random.in_box({-1, -1, -1}, {1, 1, 1}), random.direction() * 0.02, 0.02);
    return mesh;
}

Bvh<float> tree_over(const Mesh& mesh, unsigned threads)
{
    ThreadPool pool(threads);
    TriangleItems made =
        triangle_items(mesh, {0, static_cast<std::uint32_t>(mesh.triangles.size())}, pool, {});
    return *build_spatial_bvh(mesh, made.scale, std::move(made.items), {.leaf_size = 8, .block = 4}, pool);
}

// The cost of a ray that meets the whole, in areas: inner nodes and blocks of leaves.
double cost_of(const Bvh<float>& tree)
{
    double cost = 0;
    for (const BvhPair<float>& pair : tree.pairs)
        for (const BvhNode<float>& node : pair.child)
            cost += half_area_of(node) * (node.count == 0 ? 1 : (node.count + 3) / 4);
    return cost / half_area_of(tree.root);
}

} // namespace

TEST(SpatialBvh, HoldsEveryTriangleAndFewOfThemTwice)
{
    const Mesh mesh = straw(2000, 6000);
    const Bvh<float> tree = tree_over(mesh, 1);
    const std::set<std::uint32_t> held(tree.order.begin(), tree.order.end());
    EXPECT_EQ(held.size(), mesh.triangles.size());
    EXPECT_GT(tree.order.size(), mesh.triangles.size());
    EXPECT_LE(static_cast<double>(tree.order.size()),
              kMostReferences * static_cast<double>(mesh.triangles.size()));
    EXPECT_LE(tree.depth, kMaxBvhDepth);
    const auto no_leaf_holds_one_twice = [&](const BvhNode<float>& node) {
        const auto first = tree.order.begin() + node.first;
        const std::set<std::uint32_t> leaf(first, first + node.count);
        return leaf.size() == node.count;
    };
    for (const BvhPair<float>& pair : tree.pairs)
        for (const BvhNode<float>& node : pair.child)
            ASSERT_TRUE(node.count == 0 || no_leaf_holds_one_twice(node));
}

TEST(SpatialBvh, IsTheSameOnAnyNumberOfThreads)
{
    const Mesh mesh = straw(5000, 15000); // the first levels and what is grown apart
    const Bvh<float> one = tree_over(mesh, 1);
    for (const unsigned threads : {2u, 5u}) {
        const Bvh<float> many = tree_over(mesh, threads);
        ASSERT_EQ(many.pairs.size(), one.pairs.size());
        EXPECT_TRUE(std::ranges::equal(many.order, one.order));
        EXPECT_EQ(std::memcmp(many.pairs.data(), one.pairs.data(), one.pairs.size_bytes()), 0);
    }
}

TEST(SpatialBvh, CostsRaysLessAmongLongTriangles)
{
    const Mesh mesh = straw(2000, 6000);
    ThreadPool pool(1);
    TriangleItems made =
        triangle_items(mesh, {0, static_cast<std::uint32_t>(mesh.triangles.size())}, pool, {});
    const auto plain = build_bvh<float>(std::move(made.items), {.leaf_size = 8, .block = 4}, pool);
    EXPECT_LT(cost_of(tree_over(mesh, 1)), 0.8 * cost_of(*plain));
}

TEST(SpatialBvh, LosesNoRayAtTheCuts)
{
    const Mesh mesh = straw(300, 200);
    const MeshBvh spatial = build(mesh, BvhSplit::spatial);
    Random random(43);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        // At points of long triangles, along the axes too.
        const Triangle& v = mesh.triangles[random.below(300)];
        const double a = random.uniform(), b = random.uniform() * (1 - a);
        const Vec3d at =
            mesh.position(v[0]) * a + mesh.position(v[1]) * b + mesh.position(v[2]) * (1 - a - b);
        Vec3d from = at + random.direction() * 3.0;
        if (i % 3 == 0) from = at + Vec3d{0, 0, i % 2 == 0 ? 2.0 : -2.0};
        const Ray ray{from, at - from};
        const auto expected = spatial.closest_hit_brute_force(ray);
        ASSERT_TRUE(same(spatial.closest_hit(ray), expected)) << i;
        ASSERT_EQ(spatial.any_hit(ray), expected.has_value());
        hits += expected.has_value();
    }
    EXPECT_GT(hits, 15000);
}

TEST(SpatialBvh, StopsWhenAskedTo)
{
    const Mesh mesh = straw(100, 100);
    ThreadPool pool(1);
    std::stop_source stop;
    stop.request_stop();
    TriangleItems made =
        triangle_items(mesh, {0, static_cast<std::uint32_t>(mesh.triangles.size())}, pool, {});
    EXPECT_FALSE(build_spatial_bvh(mesh, made.scale, std::move(made.items), {}, pool, stop.get_token()));
}
