#include "renderer/accel/mesh_bvh.h"
#include "renderer/accel/prepared_mesh.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

namespace {

using namespace renderer;
using random_scenes::Random;

TEST(PreparedMesh, KnowsItsMeshAndWhatItHolds)
{
    ThreadPool pool(2);
    Mesh mesh = random_scenes::grid(50, 10);
    mesh.triangles.push_back({0, 0, 1});
    const std::uint64_t mesh_bytes = mesh.size_bytes();
    const auto prepared = prepare_mesh(mesh, MeshTree::wide_sah, pool);
    ASSERT_TRUE(prepared);
    EXPECT_EQ(mesh_of(*prepared).triangles, mesh.triangles);
    EXPECT_EQ(degenerate_triangles(*prepared), 1u);
    EXPECT_GT(bvh_bytes(*prepared), 5000u * 40);
    EXPECT_LT(bvh_bytes(*prepared), 5000u * 100);
    EXPECT_GE(size_bytes(*prepared), bvh_bytes(*prepared) + mesh_bytes / 2);
    EXPECT_TRUE(bvh_of(*prepared)->any_hit(Ray{{1, 1, 1}, {0, -1, 0}}));
}

TEST(PreparedMesh, OfAPartHitsThatPartAlone)
{
    ThreadPool pool(1);
    Random random(3);
    Mesh mesh = random_scenes::soup(random, 600, 1, 0.4);
    mesh.parts = {{"first", 0, 200}, {"middle", 200, 150}, {"last", 350, 250}};
    const auto whole = prepare_mesh(mesh, MeshTree::wide_sah, pool);
    for (const MeshPart& part : mesh.parts) {
        const auto prepared = prepare_part(whole, part, MeshTree::wide_sah, pool);
        ASSERT_TRUE(prepared);
        EXPECT_EQ(&mesh_of(*prepared), &mesh_of(*whole)) << "arrays are shared";
        EXPECT_LT(size_bytes(*prepared), size_bytes(*whole));
        Mesh alone = mesh; // the same triangles, the others taken out
        alone.triangles.assign(mesh.triangles.begin() + part.first_triangle,
                               mesh.triangles.begin() + part.first_triangle + part.triangle_count);
        const auto expected = prepare_mesh(alone, MeshTree::wide_sah, pool);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3d origin = random.direction() * 4.0;
            const Ray ray{origin, random.in_box({-1, -1, -1}, {1, 1, 1}) - origin};
            const auto hit = bvh_of(*prepared)->closest_hit(ray), other = bvh_of(*expected)->closest_hit(ray);
            ASSERT_EQ(hit.has_value(), other.has_value());
            if (!hit) continue;
            ++hits;
            ASSERT_EQ(hit->primitive, other->primitive + part.first_triangle);
            ASSERT_EQ(hit->t, other->t);
        }
        EXPECT_GT(hits, 100);
    }
}

// What is kept on disk: the same answers, to the last bit.
TEST(PreparedMesh, ComesBackFromItsBytesAsItWas)
{
    ThreadPool pool(2);
    Random random(5);
    Mesh mesh = random_scenes::soup(random, 500, 1, 0.4);
    mesh.triangles.push_back({0, 0, 1});
    const auto first = prepare_mesh(mesh, MeshTree::wide_sah, pool);
    const TreeBytes bytes = tree_bytes(*first);
    // Elsewhere in memory, as a mapped file would have them.
    struct alignas(TreeBytes::kAlignment) Line {
        std::byte bytes[TreeBytes::kAlignment];
    };
    const auto keeper = std::make_shared<std::vector<std::vector<Line>>>();
    TreeBytes copy{bytes.head, {}};
    for (const auto array : bytes.arrays) {
        std::vector<Line>& lines = keeper->emplace_back(array.size() / sizeof(Line) + 1);
        if (!array.empty()) std::memcpy(lines.data(), array.data(), array.size());
        copy.arrays.push_back(std::as_bytes(std::span(lines)).first(array.size()));
    }
    const auto second = prepared_from(mesh, copy, keeper);
    ASSERT_TRUE(second);
    EXPECT_EQ(bvh_bytes(*second), bvh_bytes(*first));
    EXPECT_EQ(degenerate_triangles(*second), 1u);
    EXPECT_EQ(bvh_of(*second)->bounds().lower, bvh_of(*first)->bounds().lower);
    EXPECT_EQ(bvh_of(*second)->depth(), bvh_of(*first)->depth());
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3d origin = random.direction() * 4.0;
        const Ray ray{origin, random.in_box({-1, -1, -1}, {1, 1, 1}) - origin};
        const auto hit = bvh_of(*second)->closest_hit(ray), other = bvh_of(*first)->closest_hit(ray);
        ASSERT_EQ(hit.has_value(), other.has_value());
        if (!hit) continue;
        ++hits;
        ASSERT_EQ(hit->primitive, other->primitive);
        ASSERT_EQ(hit->t, other->t);
    }
    EXPECT_GT(hits, 100);

    copy.arrays[0] = copy.arrays[0].first(copy.arrays[0].size() - 1);
    EXPECT_FALSE(prepared_from(mesh, copy, keeper));
    copy = bytes;
    copy.head.pop_back();
    EXPECT_FALSE(prepared_from(mesh, copy, keeper));
}

TEST(PreparedMesh, IsNotMadeOnceStopIsRequested)
{
    ThreadPool pool(1);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(prepare_mesh(random_scenes::grid(50, 1), MeshTree::wide_sah, pool, stop.get_token()));
    const auto whole = prepare_mesh(random_scenes::grid(50, 1), MeshTree::wide_midpoint, pool);
    EXPECT_FALSE(prepare_part(whole, {"", 0, 100}, MeshTree::wide_sah, pool, stop.get_token()));
}

} // namespace
