#include "renderer/geometry/validate_mesh.h"
#include "server/import/flat_mesh.h"
#include "server/import/flat_texts.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace {

using server::ImportedAsset;
using server::ImportFailure;
using server::ImportOutcome;
using Bytes = std::vector<std::byte>;

ImportedAsset tetrahedron()
{
    ImportedAsset asset;
    asset.format = "obj";
    asset.notes = {"a note", "zwölf Boxkämpfer"};
    renderer::Mesh& mesh = asset.mesh;
    mesh.origin = {1e9, -0.125, 3};
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.residuals = {{0, 0, 0}, {1e-9f, 0, 0}, {0, -2e-8f, 0}, {0, 0, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    mesh.triangle_materials = {0, 1, 1, 0};
    mesh.materials = {{"red", {1, 0, 0}, {0, 0, 0}, 1, {"red.png", "bump.png"}},
                      {"shiny", {}, {1, 1, 1}, 99, {}, true, false, true, false},
                      {"glassy", {}, {}, 0, {}, false, true, false, true}};
    mesh.parts = {{"base", 0, 1}, {"sides", 1, 3}};
    mesh.materials[0].color_map = renderer::TextureUse{.image = 0, .wrap = renderer::TextureWrap::mirror};
    mesh.materials[0].alpha_map = renderer::TextureUse{.image = 1, .channel = 3};
    mesh.materials[0].cutoff = 0.25f;
    mesh.materials[2].is_glass = true;
    mesh.materials[2].ior = 1.25f;
    mesh.materials[2].absorption = {0, 1, 2};
    mesh.materials[2].transmission = {0.5f, 1, 0.25f};
    mesh.images = {{"red.png", {1, 1, 3, renderer::PixelType::whole_8, {}}},
                   {"bump.png", {1, 1, 1, renderer::PixelType::real_32, {}}}};
    mesh.images[0].image.bytes.append({std::byte{9}, std::byte{8}, std::byte{7}});
    mesh.images[1].image.bytes.append({std::byte{0}, std::byte{0}, std::byte{0}, std::byte{0x3f}}); // 0.5
    return asset;
}

Bytes written(const ImportOutcome& outcome)
{
    Bytes bytes;
    write_flat(outcome,
               [&](std::span<const std::byte> more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
    return bytes;
}

// As a mapping would hold them.
server::MappedBytes mapped(const Bytes& bytes)
{
    const auto kept = std::make_shared<const Bytes>(bytes);
    return {*kept, kept};
}

std::string code_of(const ImportOutcome& outcome)
{
    const auto* failure = std::get_if<ImportFailure>(&outcome);
    return failure ? failure->code : "ok";
}

// The count at `offset` of the head: 16 positions, 24 normals, 32 uvs, 40 triangles, 48 materials, 56 text
// bytes, 64 residuals.
Bytes with_count(Bytes bytes, std::size_t offset, std::uint64_t count)
{
    std::memcpy(bytes.data() + offset, &count, sizeof count);
    return bytes;
}

TEST(FlatMesh, GivesBackWhatWasWritten)
{
    const ImportOutcome back = server::read_flat(mapped(written(tetrahedron())), {});
    ASSERT_EQ(code_of(back), "ok");
    const auto& asset = std::get<ImportedAsset>(back);
    const ImportedAsset before = tetrahedron();
    EXPECT_EQ(asset.format, before.format);
    EXPECT_EQ(asset.notes, before.notes);
    EXPECT_EQ(asset.mesh.origin, before.mesh.origin);
    EXPECT_EQ(asset.mesh.positions, before.mesh.positions);
    EXPECT_EQ(asset.mesh.residuals, before.mesh.residuals);
    EXPECT_EQ(asset.mesh.normals, before.mesh.normals);
    EXPECT_EQ(asset.mesh.uvs, before.mesh.uvs);
    EXPECT_EQ(asset.mesh.triangles, before.mesh.triangles);
    EXPECT_EQ(asset.mesh.triangle_materials, before.mesh.triangle_materials);
    ASSERT_EQ(asset.mesh.images.size(), 2u);
    for (const std::size_t i : {0u, 1u}) {
        EXPECT_EQ(asset.mesh.images[i].name, before.mesh.images[i].name);
        EXPECT_EQ(asset.mesh.images[i].image.bytes, before.mesh.images[i].image.bytes);
    }
    ASSERT_EQ(asset.mesh.materials.size(), 3u);
    EXPECT_EQ(asset.mesh.materials[0].color_map, before.mesh.materials[0].color_map);
    EXPECT_EQ(asset.mesh.materials[0].alpha_map, before.mesh.materials[0].alpha_map);
    EXPECT_EQ(asset.mesh.materials[0].cutoff, 0.25f);
    EXPECT_FALSE(asset.mesh.materials[1].color_map);
    for (const std::size_t i : {1u, 2u}) {
        EXPECT_EQ(asset.mesh.materials[i].emits, i == 1);
        EXPECT_EQ(asset.mesh.materials[i].is_transparent, i == 2);
        EXPECT_EQ(asset.mesh.materials[i].is_metal, i == 1);
        EXPECT_EQ(asset.mesh.materials[i].has_roughness, i == 2);
        EXPECT_EQ(asset.mesh.materials[i].is_glass, i == 2);
        EXPECT_EQ(asset.mesh.materials[i].ior, before.mesh.materials[i].ior);
        EXPECT_EQ(asset.mesh.materials[i].absorption, before.mesh.materials[i].absorption);
        EXPECT_EQ(asset.mesh.materials[i].transmission, before.mesh.materials[i].transmission);
    }
    EXPECT_EQ(asset.mesh.materials[0].textures, before.mesh.materials[0].textures);
    EXPECT_EQ(asset.mesh.materials[1].specular, before.mesh.materials[1].specular);
    ASSERT_EQ(asset.mesh.parts.size(), 2u);
    EXPECT_EQ(asset.mesh.parts[1].name, "sides");
    EXPECT_EQ(asset.mesh.parts[1].triangle_count, 3u);

    const ImportFailure failure{"truncated", "line 7: the file ends"};
    EXPECT_EQ(std::get<ImportFailure>(server::read_flat(mapped(written(failure)), {})), failure);
}

TEST(FlatMesh, RefusesEveryTruncationAndEveryTail)
{
    for (const Bytes& whole : {written(tetrahedron()), written(ImportFailure{"malformed", "why"})}) {
        for (std::size_t size = 0; size < whole.size(); ++size)
            ASSERT_EQ(code_of(server::read_flat(
                          mapped({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), {})),
                      "import_crashed")
                << size;
        Bytes longer = whole;
        longer.push_back(std::byte{0});
        EXPECT_EQ(code_of(server::read_flat(mapped(longer), {})), "import_crashed");
    }
}

TEST(FlatMesh, GivesASoundMeshOrAFailureWhateverBitsAreFlipped)
{
    const Bytes whole = written(tetrahedron());
    for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
        Bytes bytes = whole;
        bytes[bit / 8] ^= std::byte(1u << (bit % 8));
        const ImportOutcome outcome = server::read_flat(mapped(bytes), {});
        if (const auto* asset = std::get_if<ImportedAsset>(&outcome)) {
            ASSERT_FALSE(renderer::validate_mesh(asset->mesh)) << bit;
            for (const std::string& note : asset->notes)
                ASSERT_TRUE(server::is_utf8(note)) << bit;
        }
    }
}

TEST(FlatMesh, SurvivesRandomBytes)
{
    std::uint64_t state = 88172645463325252u;
    const auto random = [&] {
        state ^= state << 13;
        state ^= state >> 7;
        return state ^= state << 17;
    };
    const Bytes whole = written(tetrahedron());
    for (int round = 0; round < 20'000; ++round) {
        Bytes bytes = whole;
        for (std::uint64_t edits = 1 + random() % 8; edits-- > 0;)
            bytes[random() % bytes.size()] = std::byte(random() & 0xff);
        const ImportOutcome outcome = server::read_flat(mapped(bytes), {});
        if (const auto* asset = std::get_if<ImportedAsset>(&outcome)) {
            ASSERT_FALSE(renderer::validate_mesh(asset->mesh));
        }
    }
}

TEST(FlatMesh, RefusesCountsThatOverflow)
{
    const Bytes whole = written(tetrahedron());
    for (std::size_t offset = 16; offset < 72; offset += 8)
        for (const std::uint64_t count :
             {~0ull, 1ull << 63, (1ull << 62) + 1, 0x1555555555555556ull, 1ull << 32})
            ASSERT_EQ(code_of(server::read_flat(mapped(with_count(whole, offset, count)), {})),
                      "import_crashed")
                << offset;
}

TEST(FlatMesh, KeepsTheTriangleLimitItself)
{
    renderer::Limits limits;
    limits.triangles = 3;
    EXPECT_EQ(code_of(server::read_flat(mapped(written(tetrahedron())), limits)), "over_limit");
}

TEST(FlatMesh, RefusesTextsThatAreNotUtf8)
{
    for (const char* text : {"\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\x80"}) {
        EXPECT_FALSE(server::is_utf8(text));
        ImportedAsset asset = tetrahedron();
        asset.mesh.materials[1].name = text;
        EXPECT_EQ(code_of(server::read_flat(mapped(written(asset)), {})), "import_crashed");
    }
    for (const char* text : {"", "a", "\xc3\xb6", "\xe2\x82\xac", "\xf0\x9f\x8c\x9e"})
        EXPECT_TRUE(server::is_utf8(text));
}

TEST(FlatMesh, RefusesMeshesThatTheRendererWouldNotTake)
{
    ImportedAsset asset = tetrahedron();
    asset.mesh.triangles[2][1] = 4;
    EXPECT_EQ(code_of(server::read_flat(mapped(written(asset)), {})), "import_crashed");
    asset = tetrahedron();
    asset.mesh.parts[1].triangle_count = 4;
    EXPECT_EQ(code_of(server::read_flat(mapped(written(asset)), {})), "import_crashed");
    asset = tetrahedron();
    asset.mesh.positions[0].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(code_of(server::read_flat(mapped(written(asset)), {})), "import_crashed");
}

TEST(FlatMesh, TellsWhatIsTooLargeBeforeItIsWritten)
{
    renderer::Limits limits;
    EXPECT_EQ(code_of(within_flat_bounds(tetrahedron(), limits)), "ok");
    limits.import_output_bytes = 100;
    EXPECT_EQ(code_of(within_flat_bounds(tetrahedron(), limits)), "over_limit");
}

} // namespace
