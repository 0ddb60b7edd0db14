// Our own readers against assimp's: the same triangles in the same order, where assimp is known to read
// right.
#include "renderer/io/import_mesh.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace {

namespace fs = std::filesystem;

std::vector<renderer::Vec3f> corners_by_assimp(const std::string& path)
{
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
    std::vector<renderer::Vec3f> corners;
    for (unsigned m = 0; scene && m < scene->mNumMeshes; ++m)
        for (unsigned f = 0; f < scene->mMeshes[m]->mNumFaces; ++f)
            for (unsigned i = 0; i < scene->mMeshes[m]->mFaces[f].mNumIndices; ++i) {
                const aiVector3D& p = scene->mMeshes[m]->mVertices[scene->mMeshes[m]->mFaces[f].mIndices[i]];
                corners.push_back({p.x, p.y, p.z});
            }
    return corners;
}

void expect_as_assimp(const fs::path& path)
{
    const std::string bytes = tests::bytes_of(path);
    const auto result =
        renderer::import_mesh(path.filename().string(), std::as_bytes(std::span(bytes)), {}, {});
    ASSERT_TRUE(std::holds_alternative<renderer::ImportedMesh>(result)) << path;
    const renderer::Mesh& mesh = std::get<renderer::ImportedMesh>(result).mesh;
    const std::vector<renderer::Vec3f> peer = corners_by_assimp(path.string());
    ASSERT_EQ(mesh.triangles.size() * 3, peer.size()) << path;
    const float tolerance =
        1e-6f * max_component(mesh.bounds().extent()); // assimp's numbers are a little off
    for (std::size_t i = 0; i < peer.size(); ++i) {
        const renderer::Vec3f ours = mesh.positions[mesh.triangles[i / 3][i % 3]];
        ASSERT_LE(max_component(abs(ours - peer[i])), tolerance) << path << " corner " << i;
    }
}

TEST(MeshReaders, AgreeWithAssimpOnOurAssets)
{
    for (const char* name : {"knot.obj",
                             "knot.ply",
                             "knot_ascii.ply",
                             "knot.stl",
                             "knot_ascii.stl",
                             "two_materials.obj",
                             "sphere.obj",
                             "sphere.ply",
                             "terrain.ply"})
        expect_as_assimp(fs::path(tests::asset_dir()) / name);
}

TEST(MeshReaders, AgreeWithAssimpOnRealMeshes)
{
    const fs::path folder = fs::path(tests::source_dir()) / "../shared/assets";
    if (!fs::exists(folder)) GTEST_SKIP() << "the real meshes are not here";
    for (const char* name : {"bunny.obj", "nefertiti.obj", "ogre.obj", "sponza.obj", "museum.ply"})
        expect_as_assimp(folder / name);
}

} // namespace
