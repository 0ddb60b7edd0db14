#include "renderer/plan/mesh_use.h"

#include <gtest/gtest.h>

#include <vector>

using renderer::DiffuseMaterial;
using renderer::Mesh;
using renderer::MeshFacts;
using renderer::MeshShape;
using renderer::MeshUse;
using renderer::ObjectDescription;
using renderer::SceneDescription;
using renderer::Shading;

namespace {

SceneDescription scene_with(const std::vector<ObjectDescription>& objects)
{
    SceneDescription scene;
    scene.meshes.push_back({"a.glb", ""});
    scene.objects = objects;
    DiffuseMaterial textured;
    textured.color.texture.emplace();
    scene.materials.push_back({"plain", DiffuseMaterial{}});
    scene.materials.push_back({"textured", textured});
    return scene;
}

ObjectDescription object(std::optional<std::uint32_t> material, Shading shading = Shading::automatic)
{
    ObjectDescription made;
    made.shape = MeshShape{0, ""};
    made.material = material;
    made.shading = shading;
    return made;
}

MeshUse use_in(const SceneDescription& scene, std::uint32_t images = 1)
{
    MeshFacts facts;
    facts.images = images;
    return renderer::uses_of(scene, std::vector{facts}).at(0);
}

Mesh whole_mesh()
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
    mesh.triangles = {{0, 1, 2}};
    mesh.triangle_materials = {0};
    mesh.materials.emplace_back();
    mesh.images.emplace_back();
    return mesh;
}

} // namespace

TEST(MeshUse, IsOfNormalsWhereAnObjectIsSmooth)
{
    EXPECT_TRUE(use_in(scene_with({object(0)})).normals);
    EXPECT_TRUE(use_in(scene_with({object(0, Shading::flat), object(0, Shading::smooth)})).normals);
    EXPECT_FALSE(use_in(scene_with({object(0, Shading::flat)})).normals);
}

TEST(MeshUse, IsOfTextureCoordinatesWhereAMaterialLooksThemUp)
{
    EXPECT_FALSE(use_in(scene_with({object(0)})).uvs);
    EXPECT_TRUE(use_in(scene_with({object(0), object(1)})).uvs);
    EXPECT_TRUE(use_in(scene_with({object(std::nullopt)})).uvs);
    EXPECT_FALSE(use_in(scene_with({object(std::nullopt)}), 0).uvs) << "its own materials have no pictures";
}

TEST(MeshUse, IsOfTheMeshsOwnMaterialsWhereAnObjectHasNone)
{
    EXPECT_FALSE(use_in(scene_with({object(0)})).materials);
    EXPECT_TRUE(use_in(scene_with({object(0), object(std::nullopt)})).materials);
}

TEST(MeshUse, OfAMeshInNoObjectIsNothing)
{
    EXPECT_EQ(use_in(scene_with({})), MeshUse{});
}

TEST(MeshUse, LeavesOnlyWhatIsAskedFor)
{
    Mesh mesh = whole_mesh();
    drop_unused(mesh, {true, true, true});
    EXPECT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.uvs.size(), 3u);
    EXPECT_EQ(mesh.images.size(), 1u);

    drop_unused(mesh, {true, false, false});
    EXPECT_EQ(mesh.normals.size(), 3u);
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_TRUE(mesh.materials.empty());
    EXPECT_TRUE(mesh.triangle_materials.empty());
    EXPECT_TRUE(mesh.images.empty());
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(MeshUse, CountsTheBytesOfWhatIsLeft)
{
    MeshFacts facts;
    facts.vertices = 10;
    facts.triangles = 5;
    facts.has_normals = facts.has_uvs = facts.has_materials = true;
    EXPECT_EQ(array_bytes(facts, {}), 10 * 12u + 5 * 12u);
    EXPECT_EQ(array_bytes(facts, {true, true, true}), 10 * (12u + 12 + 8) + 5 * (12u + 2));
    facts.has_normals = false;
    EXPECT_EQ(array_bytes(facts, {true, false, false}), 10 * 12u + 5 * 12u);
}
