#include "server/import/import_service.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;
using server::BlobStore;
using server::ImportFailure;
using server::ImportRequest;
using server::PreparedAsset;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class ImportServiceTest : public testing::Test {
protected:
    std::string put(const std::string& bytes)
    {
        return blobs_.put(BlobStore::Kind::asset, std::as_bytes(std::span(bytes)));
    }
    std::string code(const ImportRequest& request, std::stop_token stop = {})
    {
        const auto result = imports_.import(request, pool_, stop);
        if (const auto* failure = std::get_if<ImportFailure>(&result)) return failure->code;
        return std::get<PreparedAsset>(result).mesh ? "ok" : "stopped";
    }

    tests::TempFolder folder_;
    BlobStore blobs_{folder_.path() / "blobs"};
    renderer::Limits limits_;
    server::Log log_{server::LogLevel::error};
    fs::path program_ = fs::path(tests::bin_dir()) / "heliograph-import";
    server::ImportService imports_{program_, blobs_, limits_, log_};
    renderer::ThreadPool pool_{2};
};

TEST_F(ImportServiceTest, ImportsAMeshOnceWhateverItIsCalled)
{
    const std::string digest = put(kTriangle);
    const auto first = imports_.import({"a.obj", digest, {}}, pool_, {});
    const auto second = imports_.import({"folder/b.obj", digest, {{"unused", "sha256:0"}}}, pool_, {});
    ASSERT_TRUE(std::holds_alternative<PreparedAsset>(first));
    EXPECT_EQ(std::get<PreparedAsset>(first).mesh, std::get<PreparedAsset>(second).mesh);
    EXPECT_EQ(imports_.imports_run(), 1u);
    EXPECT_EQ(imports_.cached_bytes(), size_bytes(*std::get<PreparedAsset>(first).mesh));
}

TEST_F(ImportServiceTest, BuildsNoTreeThatIsNotWanted)
{
    ImportRequest request{"a.obj", put(kTriangle), {}};
    std::uint64_t asked_about = 0;
    request.may_build = [&](const renderer::MeshFacts& facts) {
        asked_about = facts.triangles;
        return false;
    };
    const auto refused = std::get<PreparedAsset>(imports_.import(request, pool_, {}));
    EXPECT_EQ(asked_about, 1u);
    EXPECT_EQ(refused.mesh, nullptr);
    ASSERT_NE(refused.facts, nullptr);
    EXPECT_TRUE(refused.facts->is_shared);
    EXPECT_EQ(imports_.cached_bytes(), 0u);
    request.may_build = nullptr;
    EXPECT_EQ(code(request), "ok");
}

TEST_F(ImportServiceTest, ImportsAMeshOnceForAllWhoAskAtTheSameTime)
{
    const std::string digest = put(kTriangle);
    std::vector<std::shared_ptr<const renderer::PreparedMesh>> meshes(8);
    {
        std::vector<std::jthread> threads;
        for (auto& mesh : meshes)
            threads.emplace_back([&] {
                mesh = std::get<PreparedAsset>(imports_.import({"a.obj", digest, {}}, pool_, {})).mesh;
            });
    }
    EXPECT_THAT(meshes, testing::Each(testing::AllOf(testing::NotNull(), meshes[0])));
    EXPECT_EQ(imports_.imports_run(), 1u);
}

TEST_F(ImportServiceTest, ImportsAgainWhenAFileThatTheMeshOpensIsAnother)
{
    const std::string mesh = put("mtllib m.mtl\nusemtl a\n" + kTriangle);
    const std::string red = put("newmtl a\nKd 1 0 0\n"), blue = put("newmtl a\nKd 0 0 1\n");
    const auto diffuse = [&](const std::map<std::string, std::string>& files) {
        const auto asset = std::get<PreparedAsset>(imports_.import({"a.obj", mesh, files}, pool_, {}));
        const auto& materials = mesh_of(*asset.mesh).materials;
        return materials.empty() ? renderer::Rgb{} : materials[0].diffuse;
    };
    EXPECT_EQ(diffuse({{"m.mtl", red}}), (renderer::Rgb{1, 0, 0}));
    EXPECT_EQ(diffuse({{"m.mtl", blue}}), (renderer::Rgb{0, 0, 1}));
    EXPECT_EQ(diffuse({}), renderer::Rgb{});
    EXPECT_EQ(imports_.imports_run(), 3u);
    EXPECT_EQ(diffuse({{"m.mtl", red}, {"other", blue}}), (renderer::Rgb{1, 0, 0}));
    EXPECT_EQ(imports_.imports_run(), 3u);
}

TEST_F(ImportServiceTest, RemembersWhyAMeshDoesNotImport)
{
    const ImportRequest request{"a.obj", put("v 0 0 0\n"), {}};
    EXPECT_TRUE(std::holds_alternative<std::monostate>(imports_.known_failure(request)));
    EXPECT_EQ(code(request), "no_triangles");
    EXPECT_EQ(code(request), "no_triangles");
    EXPECT_EQ(imports_.imports_run(), 1u);
    ASSERT_TRUE(std::holds_alternative<ImportFailure>(imports_.known_failure(request)));
    EXPECT_EQ(std::get<ImportFailure>(imports_.known_failure(request)).code, "no_triangles");
}

TEST_F(ImportServiceTest, ForgetsFailuresThatMayNotComeAgain)
{
    const std::string script = folder_.write("importer", "#!/bin/sh\nkill -KILL $$\n");
    fs::permissions(script, fs::perms::owner_all);
    server::ImportService imports(script, blobs_, limits_, log_);
    const ImportRequest request{"a.obj", put(kTriangle), {}};
    for (std::uint64_t i = 1; i <= 2; ++i) {
        const auto result = imports.import(request, pool_, {});
        ASSERT_TRUE(std::holds_alternative<ImportFailure>(result));
        EXPECT_EQ(std::get<ImportFailure>(result).code, "import_out_of_memory");
        EXPECT_EQ(imports.imports_run(), i);
    }
    EXPECT_TRUE(std::holds_alternative<std::monostate>(imports.known_failure(request)));
}

TEST_F(ImportServiceTest, RemembersACrashAndGoesOn)
{
    const std::string script = folder_.write("importer", "#!/bin/sh\nkill -SEGV $$\n");
    fs::permissions(script, fs::perms::owner_all);
    server::ImportService imports(script, blobs_, limits_, log_);
    const ImportRequest request{"a.obj", put(kTriangle), {}};
    for (int i = 0; i < 2; ++i) {
        const auto result = imports.import(request, pool_, {});
        ASSERT_TRUE(std::holds_alternative<ImportFailure>(result));
        EXPECT_EQ(std::get<ImportFailure>(result).code, "import_crashed");
    }
    EXPECT_EQ(imports.imports_run(), 1u);
}

TEST_F(ImportServiceTest, LogsAtTheLevelOfItsService)
{
    const std::string digest = put("v 0 0 0\n");
    testing::internal::CaptureStderr();
    EXPECT_EQ(code({"a.obj", digest, {}}), "no_triangles"); // told at level info
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ImportServiceTest, TellsADigestThatIsNotUploaded)
{
    const std::string digest = "sha256:" + std::string(64, 'a');
    EXPECT_EQ(code({"a.obj", digest, {}}), "missing_asset");
    EXPECT_EQ(code({"a.obj", "../../etc/passwd", {}}), "missing_asset");
    EXPECT_EQ(imports_.imports_run(), 0u);
}

TEST_F(ImportServiceTest, NeverServesADamagedBlob)
{
    const std::string mesh = put("mtllib m.mtl\n" + kTriangle), mtl = put("newmtl a\nKd 1 0 0\n");
    const auto damage = [&](const std::string& digest) {
        std::fstream file(blobs_.path(BlobStore::Kind::asset, digest),
                          std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(9);
        file.put('9');
    };
    damage(mtl);
    const auto failure =
        std::get<server::ImportFailure>(imports_.import({"a.obj", mesh, {{"m.mtl", mtl}}}, pool_, {}));
    EXPECT_EQ(failure.code, "asset_damaged");
    EXPECT_NE(failure.detail.find("PUT /v1/assets/" + mtl), std::string::npos) << failure.detail;
    const std::string other = put("v 5 5 5\n" + kTriangle);
    damage(other);
    EXPECT_EQ(code({"a.obj", other, {}}), "asset_damaged");
    EXPECT_EQ(imports_.cached_bytes(), 0u);
    put("v 5 5 5\n" + kTriangle); // mends it, and the failure was not remembered
    EXPECT_EQ(code({"a.obj", other, {}}), "ok");
}

TEST_F(ImportServiceTest, StopsWhenAskedAndImportsTheNextTime)
{
    const ImportRequest request{"a.obj", put(kTriangle), {}};
    std::stop_source stop;
    stop.request_stop();
    EXPECT_EQ(code(request, stop.get_token()), "stopped");
    EXPECT_EQ(code(request), "ok");
}

TEST_F(ImportServiceTest, PreparesForEachTree)
{
    const std::string digest = put(kTriangle);
    const auto with = [&](renderer::MeshTree tree) {
        return ImportRequest{"a.obj", digest, {}, false, [tree](std::uint64_t) { return tree; }};
    };
    EXPECT_EQ(code({"a.obj", digest, {}}), "ok");
    const std::uint64_t one = imports_.cached_bytes();
    EXPECT_EQ(code(with(renderer::MeshTree::none)), "ok");
    EXPECT_EQ(code(with(renderer::MeshTree::wide_spatial)), "ok");
    EXPECT_EQ(code(with(renderer::MeshTree::wide_sah)), "ok");
    EXPECT_GT(imports_.cached_bytes(), one);
    EXPECT_EQ(imports_.imports_run(), 1u) << "what is in memory is not imported again";
}

TEST_F(ImportServiceTest, HasNoInfoOfAMeshWhoseImportWasStopped)
{
    const std::string digest = put(kTriangle);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_FALSE(imports_.info(digest, stop.get_token()));
    EXPECT_FALSE(imports_.known_info(digest));
    const auto info = imports_.info(digest, {});
    ASSERT_TRUE(info);
    const auto known = imports_.known_info(digest);
    ASSERT_TRUE(known);
    EXPECT_EQ(known->mesh->triangles, 1u);
    EXPECT_EQ(known->bytes, info->bytes);
}

TEST_F(ImportServiceTest, TellsWhatIsInAMesh)
{
    const std::string knot = tests::bytes_of(fs::path(tests::asset_dir()) / "knot.glb");
    const std::string digest = put(knot);
    const auto info = imports_.info(digest, {});
    ASSERT_TRUE(info);
    EXPECT_EQ(info->digest, digest);
    EXPECT_EQ(info->bytes, knot.size());
    ASSERT_TRUE(info->mesh);
    EXPECT_FALSE(info->fault);
    EXPECT_EQ(info->mesh->format, "glb");
    EXPECT_EQ(info->mesh->triangles, 6144u);
    EXPECT_TRUE(info->mesh->has_normals);
    EXPECT_TRUE(info->mesh->has_uvs);
    EXPECT_LT(info->mesh->lower[0], info->mesh->upper[0]);
    EXPECT_EQ(imports_.info(digest, {})->mesh->triangles, 6144u);
    EXPECT_EQ(imports_.imports_run(), 1u);
    EXPECT_EQ(imports_.cached_bytes(), 0u); // no BVH is built for it
}

TEST_F(ImportServiceTest, TellsDegenerateTrianglesAndUnusedVertices)
{
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n2 0 0\n9 9 "
        "9\n"
        "3 0 1 2\n3 0 1 3\n";
    const auto info = imports_.info(put(ply), {});
    ASSERT_TRUE(info);
    ASSERT_TRUE(info->mesh);
    EXPECT_EQ(info->mesh->degenerate_triangles, 1u);
    EXPECT_EQ(info->mesh->vertices, 5u);
    EXPECT_EQ(info->mesh->upper[0], 2); // of the vertices that are used
}

TEST_F(ImportServiceTest, TellsWhyAnAssetIsNoMesh)
{
    const auto info = imports_.info(put("\x89PNG\r\n"), {});
    ASSERT_TRUE(info);
    EXPECT_FALSE(info->mesh);
    ASSERT_TRUE(info->fault);
    EXPECT_EQ(info->fault->code, "unknown_format");
}

} // namespace
