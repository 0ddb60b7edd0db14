#include "renderer/io/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using renderer::Vec3d;

Vec3d area_of(const std::vector<Vec3d>& polygon, const renderer::Triangle& t)
{
    const Vec3d a = polygon[t[0]];
    return cross(polygon[t[1]] - a, polygon[t[2]] - a) / 2.0;
}

// Covers the polygon exactly: every triangle wound as the whole, the areas adding up to the outline's.
void expect_covered(const std::vector<Vec3d>& polygon, double area)
{
    std::vector<renderer::Triangle> triangles;
    ASSERT_TRUE(renderer::triangulate(polygon, triangles));
    ASSERT_EQ(triangles.size(), polygon.size() - 2);
    const Vec3d normal = to_double(renderer::polygon_normal(polygon));
    double sum = 0;
    for (const auto& t : triangles) {
        const double piece = dot(area_of(polygon, t), normal);
        EXPECT_GE(piece, -1e-9);
        sum += piece;
    }
    EXPECT_NEAR(sum, area, 1e-5 * area);
}

std::vector<Vec3d> star(int points, double inner)
{
    std::vector<Vec3d> corners;
    for (int i = 0; i < 2 * points; ++i) {
        const double angle = 3.14159265358979 * i / points, radius = i % 2 ? inner : 1;
        corners.push_back({radius * std::cos(angle), 0, radius * std::sin(angle)});
    }
    return corners;
}

TEST(Triangulate, SplitsADartAlongTheDiagonalInsideIt)
{
    const std::vector<Vec3d> dart{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5f, 1, 0}};
    for (std::size_t turn = 0; turn < 4; ++turn) {
        std::vector<Vec3d> turned;
        for (std::size_t i = 0; i < 4; ++i)
            turned.push_back(dart[(i + turn) % 4]);
        expect_covered(turned, 1.5);
    }
}

TEST(Triangulate, CoversStarsInAnyPlaneExactly)
{
    for (const int points : {3, 5, 50, 300})
        for (const double inner : {0.2, 0.9, 1.0})
            expect_covered(star(points, inner), points * inner * std::sin(3.14159265358979 / points));
}

TEST(Triangulate, TakesHugeConvexPolygonsAndRefusesHugeConcaveOnes)
{
    std::vector<renderer::Triangle> triangles;
    EXPECT_TRUE(renderer::triangulate(star(2000, 1), triangles));
    triangles.clear();
    EXPECT_FALSE(renderer::triangulate(star(2000, 0.5), triangles));
    EXPECT_TRUE(triangles.empty());
}

TEST(Triangulate, GivesAsManyTrianglesForDegeneratePolygons)
{
    std::vector<renderer::Triangle> triangles;
    EXPECT_TRUE(renderer::triangulate(std::vector<Vec3d>(7), triangles));
    EXPECT_EQ(triangles.size(), 5u);
    triangles.clear();
    const std::vector<Vec3d> bow{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0.5f, 0}};
    EXPECT_TRUE(renderer::triangulate(bow, triangles));
    EXPECT_EQ(triangles.size(), 3u);
}

} // namespace
