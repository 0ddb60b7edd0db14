#include "renderer/geometry/mesh_frame.h"
#include "renderer/geometry/rounding.h"
#include "renderer/geometry/validate_mesh.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace renderer;
using random_scenes::Random;

namespace {

// A triangle strip through the points.
Mesh strip(std::size_t vertices)
{
    Mesh mesh;
    for (std::uint32_t i = 0; i + 2 < vertices; ++i)
        mesh.triangles.push_back({i, i + 1, i + 2});
    return mesh;
}

Mesh framed(const std::vector<Vec3d>& points)
{
    Mesh mesh = strip(points.size());
    set_positions(mesh, points);
    return mesh;
}

std::vector<Vec3d> cloud(Random& random, std::size_t count, Vec3d center, double size)
{
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back(center + random.in_box({-size, -size, -size}, {size, size, size}));
    return points;
}

} // namespace

TEST(MeshFrame, IsTheFilesForAMeshNearItsOrigin)
{
    Random random(1);
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const double away : {0.0, 3.0, 300.0, 3000.0}) {
            const auto points = cloud(random, 100, Vec3d{1, -1, 0.5} * (away * scale), scale);
            const Mesh mesh = framed(points);
            EXPECT_EQ(mesh.origin, Vec3d{});
            EXPECT_TRUE(mesh.residuals.empty());
            for (std::size_t i = 0; i < points.size(); ++i)
                ASSERT_EQ(mesh.positions[i], to_float(points[i]));
        }
}

TEST(MeshFrame, IsTheSameWhereverAnExactMeshStands)
{
    Random random(2);
    std::vector<Vec3d> home;
    for (int i = 0; i < 100; ++i) // multiples of 2^-20
        home.push_back(Vec3d{std::floor(random.uniform(-1, 1) * 0x1p20),
                             std::floor(random.uniform(-1, 1) * 0x1p20),
                             std::floor(random.uniform(-1, 1) * 0x1p20)} *
                       0x1p-20);
    const Mesh at_home = framed(home);
    ASSERT_EQ(at_home.origin, Vec3d{});
    for (const Vec3d move :
         {Vec3d{0x1p20, 0, 0}, Vec3d{0, -0x1p23, 0x1p20}, Vec3d{0x1p30, 0x1p30, -0x1p30}}) {
        std::vector<Vec3d> away = home;
        for (Vec3d& p : away)
            p = p + move;
        const Mesh mesh = framed(away);
        EXPECT_EQ(mesh.origin, move);
        EXPECT_EQ(mesh.positions, at_home.positions);
        EXPECT_TRUE(mesh.residuals.empty());
        EXPECT_EQ(mesh.bounds_in_file().lower, at_home.bounds_in_file().lower + move);
        EXPECT_EQ(mesh.bounds_in_file().upper, at_home.bounds_in_file().upper + move);
    }
}

TEST(MeshFrame, LosesNothingOfTheFloatsOfAFile)
{
    Random random(3);
    int moved = 0;
    for (int i = 0; i < 2000; ++i) {
        const double size = std::pow(10, random.uniform(-8, 8));
        const Vec3d center{random.exponential(8), random.exponential(8), random.exponential(8)};
        Mesh mesh = strip(20);
        for (const Vec3d& p : cloud(random, 20, center, size))
            mesh.positions.push_back(to_float(p));
        const Mesh before = mesh;
        choose_origin(mesh);
        moved += mesh.origin != Vec3d{};
        for (std::size_t k = 0; k < mesh.positions.size(); ++k)
            ASSERT_EQ(mesh.position(static_cast<std::uint32_t>(k)) + mesh.origin,
                      to_double(before.positions[k]));
        if (mesh.origin == Vec3d{}) continue;
        // It is near its new origin.
        const Bounds3f box = mesh.bounds();
        ASSERT_LE(std::max(max_abs(box.lower), max_abs(box.upper)), 17 * max_component(box.extent()));
    }
    EXPECT_GT(moved, 500);
}

TEST(MeshFrame, KeepsResidualsWhereFloatsWouldSpoilTriangles)
{
    Random random(4);
    std::vector<Vec3d> points = cloud(random, 30, {0, 0, 0}, 1e6);
    const auto small = cloud(random, 30, {7e5, -5e5, 6e5}, 1e-3); // a float is 1/16 wide there
    points.insert(points.end(), small.begin(), small.end());
    const Mesh mesh = framed(points);
    EXPECT_EQ(mesh.origin, Vec3d{}) << "its size is 1e6 as well";
    ASSERT_EQ(mesh.residuals.size(), points.size());
    EXPECT_FALSE(validate_mesh(mesh));
    for (std::uint32_t i = 0; i < points.size(); ++i)
        ASSERT_LE(max_abs(mesh.position(i) - points[i]), 0x1p-47 * max_abs(points[i]));
    // The same alone: it is moved to where floats are fine enough.
    const Mesh alone = framed(small);
    EXPECT_NE(alone.origin, Vec3d{});
    EXPECT_TRUE(alone.residuals.empty());
    // Floats that a file has are all that it says.
    std::vector<Vec3d> floats = points;
    for (Vec3d& p : floats)
        p = to_double(to_float(p));
    EXPECT_TRUE(framed(floats).residuals.empty());
}

TEST(MeshFrame, RefusesResidualsThatNoRoundingLeaves)
{
    Mesh mesh = strip(3);
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.residuals = {{0x1p-24f, 0, 0}, {0, -0x1p-30f, 0}, {0, 0, 0}};
    EXPECT_FALSE(validate_mesh(mesh));
    mesh.residuals[1].x = 0x1p-60f; // of 0 nothing is rounded off
    ASSERT_TRUE(validate_mesh(mesh));
    EXPECT_NE(validate_mesh(mesh)->detail.find("vertex 1"), std::string::npos);
    mesh.residuals.pop_back();
    EXPECT_TRUE(validate_mesh(mesh));
    mesh.residuals = {};
    mesh.origin.y = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(validate_mesh(mesh));
}
