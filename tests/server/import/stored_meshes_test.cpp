#include "server/import/import_service.h"
#include "server/import/stored_meshes.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using server::BlobStore;
using server::ImportRequest;
using server::PreparedAsset;

std::string asset(const char* name)
{
    return tests::bytes_of(fs::path(tests::asset_dir()) / name);
}

// A service, ended and started again on what is left on disk as often as a test likes.
class StoredMeshesTest : public testing::Test {
protected:
    std::string put(const std::string& bytes)
    {
        return blobs_.put(BlobStore::Kind::asset, std::as_bytes(std::span(bytes)));
    }
    void start()
    {
        imports_.reset();
        imports_ = std::make_unique<server::ImportService>(program_, blobs_, limits_, log_, kept_);
    }
    std::shared_ptr<const renderer::PreparedMesh> mesh(const ImportRequest& request)
    {
        auto result = imports_->import(request, pool_, {});
        EXPECT_TRUE(std::holds_alternative<PreparedAsset>(result));
        imports_->flush();
        return std::get<PreparedAsset>(result).mesh;
    }
    std::vector<fs::path> files() const
    {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(kept_))
            found.push_back(entry.path());
        std::sort(found.begin(), found.end());
        return found;
    }
    fs::path only_file() const
    {
        const auto found = files();
        EXPECT_EQ(found.size(), 1u);
        return found.at(0);
    }
    static void flip(const fs::path& path, std::uint64_t offset)
    {
        std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
        file.seekg(static_cast<std::streamoff>(offset));
        const char byte = static_cast<char>(file.get() ^ 0x10);
        file.seekp(static_cast<std::streamoff>(offset));
        file.put(byte);
    }

    tests::TempFolder folder_;
    fs::path kept_ = folder_.path() / "meshes";
    BlobStore blobs_{folder_.path() / "blobs"};
    renderer::Limits limits_;
    server::Log log_{server::LogLevel::error};
    fs::path program_ = fs::path(tests::bin_dir()) / "heliograph-import";
    renderer::ThreadPool pool_{2};
    std::unique_ptr<server::ImportService> imports_;
};

TEST_F(StoredMeshesTest, ARestartNeitherImportsNorBuilds)
{
    const ImportRequest request{
        "box.obj", put(asset("two_materials.obj")), {{"two_materials.mtl", put(asset("two_materials.mtl"))}}};
    start();
    const auto first = mesh(request);
    EXPECT_EQ(imports_->imports_run(), 1u);
    EXPECT_EQ(imports_->stored_bytes(), fs::file_size(only_file()));
    start();
    const auto second = mesh(request);
    EXPECT_EQ(imports_->imports_run(), 0u);
    EXPECT_EQ(imports_->cached_bytes(), size_bytes(*second));
    EXPECT_EQ(mesh_of(*second).positions, mesh_of(*first).positions);
    EXPECT_EQ(mesh_of(*second).triangles, mesh_of(*first).triangles);
    EXPECT_EQ(mesh_of(*second).normals, mesh_of(*first).normals);
    EXPECT_EQ(mesh_of(*second).triangle_materials, mesh_of(*first).triangle_materials);
    ASSERT_EQ(mesh_of(*second).materials.size(), 2u);
    EXPECT_EQ(mesh_of(*second).materials[1].name, "shiny");
    EXPECT_TRUE(mesh_of(*second).positions.is_lent()) << "mapped, not copied";
    const auto first_tree = tree_bytes(*first), second_tree = tree_bytes(*second);
    EXPECT_EQ(first_tree.head, second_tree.head);
    for (std::size_t i = 0; i < first_tree.arrays.size(); ++i)
        EXPECT_TRUE(std::ranges::equal(first_tree.arrays[i], second_tree.arrays[i]));
}

TEST_F(StoredMeshesTest, KeepsEachSplitAndMindsTheFilesThatTheMeshOpens)
{
    const std::string obj = put("mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string red = put("newmtl a\nKd 1 0 0\n"), blue = put("newmtl a\nKd 0 0 1\n");
    start();
    const auto with = [&](std::map<std::string, std::string> named, renderer::MeshTree tree) {
        return mesh({"a.obj", obj, std::move(named), false, [tree](std::uint64_t) { return tree; }});
    };
    with({{"m.mtl", red}}, renderer::MeshTree::wide_sah);
    with({{"m.mtl", red}}, renderer::MeshTree::wide_midpoint);
    EXPECT_EQ(imports_->imports_run(), 1u);
    EXPECT_EQ(files().size(), 2u);
    start();
    with({{"m.mtl", red}, {"other", blue}}, renderer::MeshTree::wide_midpoint);
    EXPECT_EQ(imports_->imports_run(), 0u);
    const auto other = with({{"m.mtl", blue}}, renderer::MeshTree::wide_sah);
    EXPECT_EQ(imports_->imports_run(), 1u);
    EXPECT_EQ(mesh_of(*other).materials[0].diffuse, (renderer::Rgb{0, 0, 1}));
}

TEST_F(StoredMeshesTest, AMeshThatTheCacheHasNoRoomForIsNotImportedAgain)
{
    const ImportRequest request{"knot.ply", put(asset("knot.ply")), {}};
    limits_.mesh_cache_bytes = 1;
    start();
    mesh(request);
    EXPECT_TRUE(mesh(request));
    EXPECT_EQ(imports_->imports_run(), 1u);
    EXPECT_EQ(imports_->cached_bytes(), 0u);
    start();
    EXPECT_TRUE(mesh(request));
    EXPECT_EQ(imports_->imports_run(), 0u);
}

// A mesh that is known with another tree is not imported again: the one that is asked for is built, and kept as well.
TEST_F(StoredMeshesTest, BuildsAnotherTreeOverAMeshThatItHas)
{
    ImportRequest request{"knot.ply", put(asset("knot.ply")), {}};
    start();
    mesh(request);
    start();
    std::uint64_t triangles = 0;
    request.tree_for = [&](std::uint64_t count) {
        triangles = count;
        return renderer::MeshTree::wide_spatial;
    };
    const auto built = mesh(request);
    EXPECT_EQ(triangles, mesh_of(*built).triangles.size());
    EXPECT_EQ(imports_->imports_run(), 0u);
    EXPECT_EQ(files().size(), 2u);
    start();
    const auto again = mesh(request);
    EXPECT_EQ(imports_->imports_run(), 0u);
    EXPECT_EQ(files().size(), 2u);
    const auto built_tree = tree_bytes(*built), kept_tree = tree_bytes(*again);
    EXPECT_TRUE(std::ranges::equal(kept_tree.arrays[0], built_tree.arrays[0]));
}

// Wherever a bit is lost, and wherever the file is cut: it is made again, and right.
TEST_F(StoredMeshesTest, NeverGivesADamagedMesh)
{
    const ImportRequest request{"knot.ply", put(asset("knot.ply")), {}};
    start();
    const auto sound = mesh(request);
    const std::uint64_t size = fs::file_size(only_file());
    std::vector<std::uint64_t> places{0, 8, 16, 40, 80, 120, 160, 200, 4096, 4096 + 8, 4096 + 64};
    for (std::uint64_t at = 5000; at < size; at += size / 12)
        places.push_back(at);
    places.push_back(size - 1);
    for (const std::uint64_t place : places) {
        flip(only_file(), place);
        start();
        const auto again = mesh(request);
        // Zeros between the parts of the head and the body are no part of the mesh.
        if (imports_->imports_run() == 0) {
            EXPECT_LT(place, 4096u);
        }
        ASSERT_EQ(mesh_of(*again).positions, mesh_of(*sound).positions) << place;
        ASSERT_TRUE(std::ranges::equal(tree_bytes(*again).arrays[0], tree_bytes(*sound).arrays[0])) << place;
        if (imports_->imports_run() == 0) flip(only_file(), place);
    }
    for (const std::uint64_t length :
         {std::uint64_t{0}, std::uint64_t{7}, std::uint64_t{300}, size / 2, size - 1}) {
        fs::resize_file(only_file(), length);
        start();
        EXPECT_EQ(mesh_of(*mesh(request)).triangles, mesh_of(*sound).triangles);
        EXPECT_EQ(imports_->imports_run(), 1u) << length;
        EXPECT_EQ(fs::file_size(only_file()), size);
    }
}

TEST_F(StoredMeshesTest, RemovesWhatItCannotUse)
{
    const std::string digest = put(asset("knot.ply"));
    start();
    mesh({"knot.ply", digest, {}});
    std::ofstream(kept_ / ".being-written") << "left by a kill";
    std::ofstream(kept_ / "readme") << "of somebody else";
    start();
    EXPECT_EQ(files().size(), 1u);
    blobs_.remove(BlobStore::Kind::asset, digest);
    start();
    EXPECT_TRUE(files().empty());
    EXPECT_EQ(imports_->stored_bytes(), 0u);
}

TEST_F(StoredMeshesTest, AnotherBuildDoesNotTakeThem)
{
    const ImportRequest request{"knot.ply", put(asset("knot.ply")), {}};
    start();
    mesh(request);
    const fs::path other = folder_.path() / "heliograph-import";
    fs::copy_file(program_, other);
    std::ofstream(other, std::ios::binary | std::ios::app) << "as another compiler would make it";
    program_ = other;
    start();
    mesh(request);
    EXPECT_EQ(imports_->imports_run(), 1u);
}

TEST_F(StoredMeshesTest, KeepsToItsBytesAndDropsTheLeastRecentlyUsed)
{
    const ImportRequest knot{"knot.ply", put(asset("knot.ply")), {}},
        sphere{"sphere.ply", put(asset("sphere.ply")), {}},
        terrain{"terrain.ply", put(asset("terrain.ply")), {}};
    start();
    const auto held = mesh(knot);
    const std::uint64_t knot_bytes = imports_->stored_bytes();
    mesh(sphere);
    const std::uint64_t both = imports_->stored_bytes();
    limits_.stored_mesh_bytes = both;
    start();
    mesh(sphere);
    mesh(knot); // now the last used
    EXPECT_EQ(imports_->imports_run(), 0u);
    EXPECT_EQ(imports_->stored_bytes(), both);
    const auto mapped = mesh(knot);
    mesh(terrain);
    EXPECT_LE(imports_->stored_bytes(), both);
    limits_.stored_mesh_bytes = knot_bytes - 1;
    start();
    EXPECT_LT(imports_->stored_bytes(), knot_bytes);
    EXPECT_EQ(mesh_of(*mapped).positions, mesh_of(*held).positions) << "removed while it is in use";
    limits_.stored_mesh_bytes = 0;
    start();
    mesh(knot);
    EXPECT_TRUE(files().empty());
}

TEST_F(StoredMeshesTest, DoesWithoutAFolderThatCannotBeMade)
{
    std::ofstream(kept_) << "a file in its place";
    start();
    EXPECT_TRUE(mesh({"knot.ply", put(asset("knot.ply")), {}}));
    EXPECT_EQ(imports_->stored_bytes(), 0u);
}

} // namespace
