#include "renderer/io/closed_glass.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

using namespace renderer;

namespace {

// A tetrahedron whose corners each triangle has for itself, as meshes with normals of their own have.
Mesh tetrahedron_of_glass()
{
    const Vec3f corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::uint32_t faces[][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    Mesh mesh;
    for (const auto& face : faces) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const std::uint32_t corner : face)
            mesh.positions.push_back(corners[corner]);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    mesh.materials.resize(1);
    mesh.materials[0].name = "pane";
    mesh.materials[0].is_glass = true;
    return mesh;
}

struct Kept {
    std::vector<bool> is_glass;
    std::vector<std::string> notes;
};

Kept kept_of(Mesh mesh)
{
    Kept kept;
    keep_closed_glass(mesh, kept.notes);
    for (const MeshMaterial& material : mesh.materials) {
        kept.is_glass.push_back(material.is_glass);
        EXPECT_FALSE(material.is_glass && material.is_transparent);
    }
    return kept;
}

} // namespace

TEST(ClosedGlass, IsWhatSurroundsABodyWhicheverWayItsFacesTurn)
{
    Mesh mesh = tetrahedron_of_glass();
    EXPECT_EQ(kept_of(mesh).is_glass, std::vector{true});
    EXPECT_TRUE(kept_of(mesh).notes.empty());
    for (Triangle& triangle : mesh.triangles)
        std::swap(triangle[0], triangle[1]);
    EXPECT_EQ(kept_of(mesh).is_glass, std::vector{true});
}

TEST(ClosedGlass, IsNotASheetAndSaysSo)
{
    Mesh open = tetrahedron_of_glass();
    open.triangles.pop_back();
    const Kept kept = kept_of(open);
    EXPECT_EQ(kept.is_glass, std::vector{false});
    ASSERT_EQ(kept.notes.size(), 1u);
    EXPECT_NE(kept.notes[0].find("\"pane\""), std::string::npos) << kept.notes[0];

    Mesh turned = tetrahedron_of_glass(); // one face inside out: which side is glass cannot be told
    std::swap(turned.triangles[2][0], turned.triangles[2][1]);
    EXPECT_EQ(kept_of(turned).is_glass, std::vector{false});
}

TEST(ClosedGlass, IsSoughtAmongTheTrianglesOfItsOwnMaterial)
{
    Mesh mesh = tetrahedron_of_glass();
    mesh.triangle_materials = {0, 0, 0, 1};
    mesh.materials.resize(2);
    EXPECT_EQ(kept_of(mesh).is_glass, (std::vector{false, false})) << "its last side is of something else";
    const auto corners = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f corner : {Vec3f{5, 0, 0}, Vec3f{6, 0, 0}, Vec3f{5, 1, 0}})
        mesh.positions.push_back(corner);
    mesh.triangles.push_back({corners, corners + 1, corners + 2});
    mesh.triangle_materials = {0, 0, 0, 0, 1};
    EXPECT_EQ(kept_of(mesh).is_glass, (std::vector{true, false}));
}
