#include "renderer/geometry/shapes.h"
#include "renderer/geometry/validate_mesh.h"

#include <gtest/gtest.h>

namespace {

using namespace renderer;

double area(const Mesh& mesh)
{
    double sum = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = to_double(mesh.positions[t[0]]);
        sum += length(cross(to_double(mesh.positions[t[1]]) - a, to_double(mesh.positions[t[2]]) - a)) / 2;
    }
    return sum;
}

// Winding, normals and outside agree: outside is where `outwards` of the triangle's centre points.
void expect_faces_out(const Mesh& mesh, bool from_origin)
{
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = to_double(mesh.positions[t[0]]), b = to_double(mesh.positions[t[1]]),
                    c = to_double(mesh.positions[t[2]]);
        const Vec3d n = normalize(cross(b - a, c - a));
        EXPECT_GT(dot(n, from_origin ? a + b + c : Vec3d{0, 0, 1}), 0);
        for (const std::uint32_t v : t)
            EXPECT_EQ(to_double(mesh.normals[v]), n);
    }
}

TEST(UnitRectangle, LiesInTheXyPlaneFacingZ)
{
    const Mesh mesh = unit_rectangle();
    EXPECT_FALSE(validate_mesh(mesh));
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.bounds(), (Bounds3f{{-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}}));
    EXPECT_EQ(area(mesh), 1);
    expect_faces_out(mesh, false);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(mesh.uvs[i], (Vec2f{mesh.positions[i].x + 0.5f, mesh.positions[i].y + 0.5f}));
}

TEST(UnitBox, IsClosedAndFacesOutwards)
{
    const Mesh mesh = unit_box();
    EXPECT_FALSE(validate_mesh(mesh));
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(mesh.bounds(), (Bounds3f{{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}));
    EXPECT_EQ(area(mesh), 6);
    expect_faces_out(mesh, true);
    for (std::size_t face = 0; face < 6; ++face)
        EXPECT_EQ(mesh.uvs[4 * face + 2], (Vec2f{1, 1}));
}

} // namespace
