#include "renderer/accel/triangle_items.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace {

using namespace renderer;

// Enough triangles for several threads; every third has no area, and all of the second ten thousand.
Mesh gappy_mesh()
{
    random_scenes::Random random(4);
    Mesh mesh = random_scenes::soup(random, 50000, 1, 0.1);
    for (std::uint32_t i = 0; i < 50000; ++i)
        if (i % 3 == 0 || (i >= 10000 && i < 20000)) mesh.triangles[i][2] = mesh.triangles[i][1];
    return mesh;
}

TEST(TriangleItems, AreTheTrianglesWithAnAreaInTheirOrder)
{
    const Mesh mesh = gappy_mesh();
    ThreadPool pool(2);
    const TriangleItems made = triangle_items(mesh, {5, 40000}, pool, {});
    std::size_t next = 0;
    Bounds3f bounds;
    for (std::uint32_t i = 5; i < 40005; ++i) {
        if (i % 3 == 0 || (i >= 10000 && i < 20000)) continue;
        ASSERT_LT(next, made.items.size());
        const BuildItem<float>& item = made.items[next++];
        ASSERT_EQ(item.primitive, i);
        Bounds3f box;
        for (const std::uint32_t vertex : mesh.triangles[i])
            box.extend(mesh.positions[vertex]);
        ASSERT_EQ(box, (Bounds3f{item.lower, item.upper}));
        bounds.extend(box);
    }
    EXPECT_EQ(next, made.items.size());
    EXPECT_EQ(bounds, made.bounds);
    EXPECT_EQ(made.scale, 1);
}

TEST(TriangleItems, AreScaledWhereTheMeshIsFarFromOne)
{
    random_scenes::Random random(5);
    const Mesh mesh = random_scenes::soup(random, 100, 1e-20, 1e-21);
    ThreadPool pool(1);
    const TriangleItems made = triangle_items(mesh, {0, 100}, pool, {});
    ASSERT_EQ(made.items.size(), 100u);
    EXPECT_GT(made.scale, 1e15f);
    for (const BuildItem<float>& item : made.items)
        EXPECT_EQ(item.upper.x / made.scale * made.scale, item.upper.x);
    EXPECT_LE(made.bounds.upper.x, 1.2e-20f);
}

} // namespace
