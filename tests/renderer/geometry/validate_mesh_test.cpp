#include "renderer/geometry/shapes.h"
#include "renderer/geometry/validate_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace {

using namespace renderer;
using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Mesh complete()
{
    Mesh mesh = unit_box();
    mesh.materials.resize(2);
    mesh.materials[1].name = "wood";
    mesh.triangle_materials.assign(12, 1);
    mesh.parts = {{"lower", 0, 4}, {"upper", 4, 8}};
    return mesh;
}

void expect_fault(const std::function<void(Mesh&)>& harm, const std::string& code, const std::string& says)
{
    Mesh mesh = complete();
    harm(mesh);
    const std::optional<Fault> fault = validate_mesh(mesh);
    ASSERT_TRUE(fault) << code << ", " << says;
    EXPECT_EQ(fault->code, code);
    EXPECT_THAT(fault->detail, HasSubstr(says));
    EXPECT_EQ(fault->pointer, "");
}

TEST(ValidateMesh, PassesWhatIsSound)
{
    EXPECT_FALSE(validate_mesh(complete()));
}

TEST(ValidateMesh, RefusesNumbersThatAreNotFiniteAndNamesTheVertex)
{
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
        expect_fault([&](Mesh& m) { m.positions[7].y = bad; }, "non_finite", "position of vertex 7");
        expect_fault([&](Mesh& m) { m.normals[23].z = bad; }, "non_finite", "normal of vertex 23");
        expect_fault([&](Mesh& m) { m.uvs[0].x = bad; }, "non_finite", "texture coordinate of vertex 0");
        expect_fault([&](Mesh& m) { m.uvs[3].y = bad; }, "non_finite", "texture coordinate of vertex 3");
        expect_fault([&](Mesh& m) { m.materials[1].shininess = bad; }, "non_finite", "material 1 (\"wood\")");
    }
}

TEST(ValidateMesh, RefusesGlassThatCannotBe)
{
    expect_fault([](Mesh& m) { m.materials[1].ior = 0; }, "out_of_range", "index of refraction");
    expect_fault([](Mesh& m) { m.materials[0].ior = 11; }, "out_of_range", "material 0");
    expect_fault([](Mesh& m) { m.materials[1].absorption.g = -1; }, "out_of_range", "absorbs less");
}

TEST(ValidateMesh, RefusesIndicesOutOfRangeAndNamesTheTriangle)
{
    expect_fault([](Mesh& m) { m.triangles[5][2] = 24; }, "index_out_of_range", "triangle 5 names vertex 24");
    expect_fault([](Mesh& m) { m.triangles[0][0] = 0xffffffffu; }, "index_out_of_range", "triangle 0");
    expect_fault(
        [](Mesh& m) { m.triangle_materials[11] = 2; }, "index_out_of_range", "triangle 11 names material 2");
    expect_fault([](Mesh& m) { m.materials.clear(); }, "index_out_of_range", "triangle 0 names material 1");
    expect_fault([](Mesh& m) { m.parts[1].triangle_count = 9; }, "index_out_of_range", "part \"upper\"");
    expect_fault(
        [](Mesh& m) { m.parts[1].first_triangle = 0xffffffffu; }, "index_out_of_range", "part \"upper\"");
    expect_fault([](Mesh& m) { m.parts[0].triangle_count = 0; }, "index_out_of_range", "part \"lower\"");
}

TEST(ValidateMesh, RefusesArraysThatDoNotFit)
{
    expect_fault([](Mesh& m) { m.triangles.clear(); }, "no_triangles", "no triangles");
    expect_fault([](Mesh& m) { m = Mesh{}; }, "no_triangles", "no triangles");
    expect_fault([](Mesh& m) { m.normals.pop_back(); }, "inconsistent", "23 normals for 24 vertices");
    expect_fault([](Mesh& m) { m.uvs.push_back({}); }, "inconsistent", "25 texture coordinates");
    expect_fault([](Mesh& m) { m.triangle_materials.pop_back(); }, "inconsistent", "11 material numbers");
    expect_fault([](Mesh& m) { m.positions.clear(); }, "inconsistent", "for 0 vertices");
}

TEST(Mesh, BoundsAreOfTheVerticesInUse)
{
    Mesh mesh = unit_rectangle();
    mesh.positions.push_back({100, 100, 100});
    EXPECT_EQ(mesh.bounds(), (Bounds3f{{-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}}));
    EXPECT_TRUE(Mesh{}.bounds().empty());
}

TEST(Mesh, CountsItsBytes)
{
    Mesh mesh = unit_box();
    const std::uint64_t before = mesh.size_bytes();
    EXPECT_GE(before, 24 * (sizeof(Vec3f) * 2 + sizeof(Vec2f)) + 12 * sizeof(Triangle));
    mesh.parts.push_back({std::string(1000, 'x'), 0, 1});
    EXPECT_GE(mesh.size_bytes(), before + 1000 + sizeof(MeshPart));
}

} // namespace
