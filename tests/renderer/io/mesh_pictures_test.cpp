// The pictures that meshes' own materials name: of files beside them, and within them.
#include "renderer/io/import_mesh.h"
#include "tests/support/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>

namespace {

using renderer::ImportedMesh;
using renderer::ImportFault;
using renderer::MeshMaterial;

using Files = std::map<std::string, std::string, std::less<>>;

std::string picture(const std::string& name)
{
    std::ifstream file(tests::asset_dir() + "/images/" + name, std::ios::binary);
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>(file), {}};
}

ImportedMesh import(const std::string& name, const std::string& bytes, const Files& files = {})
{
    const renderer::OpenFile open = [&](std::string_view asked) -> std::optional<std::span<const std::byte>> {
        const auto file = files.find(asked);
        if (file == files.end()) return std::nullopt;
        return std::as_bytes(std::span(file->second));
    };
    auto result = renderer::import_mesh(name, std::as_bytes(std::span(bytes)), open, {});
    if (const auto* fault = std::get_if<ImportFault>(&result))
        ADD_FAILURE() << fault->code << ": " << fault->detail;
    return std::holds_alternative<ImportedMesh>(result) ? std::get<ImportedMesh>(std::move(result))
                                                        : ImportedMesh();
}

const std::string kObj =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";

ImportedMesh obj_with(const std::string& mtl, Files files)
{
    files["m.mtl"] = "newmtl m\n" + mtl;
    return import("a.obj", kObj, files);
}

TEST(MeshPictures, OfAnMtlAreDecodedOnceEach)
{
    const ImportedMesh mesh =
        obj_with("Kd 0.5 0.5 0.5\nmap_Kd wood.png\nmap_Ks wood.png\n", {{"wood.png", picture("rgb.png")}});
    ASSERT_EQ(mesh.mesh.images.size(), 1u);
    EXPECT_EQ(mesh.mesh.images[0].image.width, 5u);
    ASSERT_EQ(mesh.mesh.materials.size(), 1u);
    const MeshMaterial& m = mesh.mesh.materials[0];
    EXPECT_EQ(m.diffuse, (renderer::Rgb{0.5f, 0.5f, 0.5f})); // the picture is multiplied by it
    ASSERT_TRUE(m.color_map && m.specular_map);
    EXPECT_EQ(m.color_map->image, 0u);
    EXPECT_TRUE(mesh.notes.empty());
    EXPECT_THAT(mesh.opened_files, testing::UnorderedElementsAre("m.mtl", "wood.png"));
}

TEST(MeshPictures, StandBeforeWhiteWhereAnMtlGivesNoColour)
{
    const ImportedMesh mesh = obj_with("map_Kd wood.png\n", {{"wood.png", picture("rgb.jpg")}});
    EXPECT_EQ(mesh.mesh.materials.at(0).diffuse, (renderer::Rgb{1, 1, 1}));
}

TEST(MeshPictures, MakeHolesByMapD)
{
    const Files files{{"leaf.png", picture("rgba.png")}, {"mask.png", picture("grey.png")}};
    const MeshMaterial alpha = obj_with("map_d leaf.png\n", files).mesh.materials.at(0);
    ASSERT_TRUE(alpha.alpha_map);
    EXPECT_EQ(alpha.alpha_map->channel, 3);
    EXPECT_EQ(alpha.cutoff, 0.5f);
    const MeshMaterial grey =
        obj_with("map_d -clamp on mask.png\nnorm leaf.png\n", files).mesh.materials.at(0);
    ASSERT_TRUE(grey.alpha_map && grey.normal_map);
    EXPECT_EQ(grey.alpha_map->channel, 0);
    EXPECT_EQ(grey.alpha_map->wrap, renderer::TextureWrap::clamp);
}

TEST(MeshPictures, ThatDidNotComeOrAreBrokenAreNotes)
{
    const ImportedMesh gone = obj_with("Kd 1 0 0\nmap_Kd gone.png\n", {});
    EXPECT_FALSE(gone.mesh.materials.at(0).color_map);
    EXPECT_THAT(gone.notes, testing::ElementsAre(testing::HasSubstr("gone.png did not come")));
    const ImportedMesh broken =
        obj_with("Kd 1 0 0\nmap_Kd a.png\n", {{"a.png", picture("broken/lying_size.png")}});
    EXPECT_FALSE(broken.mesh.materials.at(0).color_map);
    EXPECT_TRUE(broken.mesh.images.empty());
    EXPECT_THAT(broken.notes, testing::ElementsAre(testing::HasSubstr("a.png is left out")));
}

TEST(MeshPictures, AreFoundUnderNamesOfAnotherSystem)
{
    EXPECT_EQ(obj_with("map_Kd textures\\wood.png\n", {{"textures/wood.png", picture("rgb.png")}})
                  .mesh.images.size(),
              1u);
}

std::string base64(const std::string& bytes)
{
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t j = 0; j < 3; ++j)
            bits = bits << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
        for (std::size_t j = 0; j < 4; ++j)
            out += i + j > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * j) & 63u];
    }
    return out;
}

template <typename T>
void put(std::string& out, T value)
{
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// A triangle with coordinates, its material, and one picture behind it in the buffer.
std::string
gltf_with(const std::string& material, const std::string& image, const std::string& more_bytes = "")
{
    std::string buffer;
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
        put(buffer, x);
    for (const float x : {0.f, 0.f, 1.f, 0.f, 0.f, 1.f})
        put(buffer, x);
    buffer += more_bytes;
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[
        {"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],"accessors":[
        {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
        {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"}],"bufferViews":[
        {"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
        {"buffer":0,"byteOffset":60,"byteLength":)" +
           std::to_string(std::max<std::size_t>(more_bytes.size(), 0)) +
           R"(}],"samplers":[{"wrapS":33071,"wrapT":33071}],"textures":[{"source":0,"sampler":0}],"images":[)" +
           image + R"(],"materials":[)" + material + R"(],"buffers":[{"byteLength":)" +
           std::to_string(buffer.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
           base64(buffer) + R"("}]})";
}

const std::string kTextured =
    R"({"name":"m","alphaMode":"MASK","alphaCutoff":0.3,"normalTexture":{"index":0},"emissiveTexture":{"index":0},
    "pbrMetallicRoughness":{"baseColorFactor":[1,0.5,1,0.9],"metallicFactor":0.75,"roughnessFactor":0.5,
    "baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}}})";

void expect_textured(const ImportedMesh& mesh)
{
    ASSERT_EQ(mesh.mesh.images.size(), 1u);
    EXPECT_EQ(mesh.mesh.images[0].image.width, 5u);
    ASSERT_GE(mesh.mesh.materials.size(), 1u);
    const MeshMaterial& m = mesh.mesh.materials[0];
    EXPECT_TRUE(m.is_physical);
    EXPECT_EQ(m.diffuse, (renderer::Rgb{1, 0.5f, 1}));
    EXPECT_EQ(m.metallic, 0.75f);
    EXPECT_EQ(m.roughness, 0.5f);
    EXPECT_EQ(m.opacity, 0.9f);
    EXPECT_EQ(m.cutoff, 0.3f);
    EXPECT_FALSE(m.is_transparent);
    EXPECT_TRUE(m.color_map && m.physical_map && m.normal_map && m.emission_map);
    ASSERT_TRUE(m.color_map);
    EXPECT_EQ(m.color_map->wrap, renderer::TextureWrap::clamp);
    ASSERT_EQ(mesh.mesh.uvs.size(), 3u);
    EXPECT_TRUE(mesh.notes.empty());
}

TEST(MeshPictures, OfAGltfComeFromItsBuffer)
{
    expect_textured(import(
        "a.gltf", gltf_with(kTextured, R"({"bufferView":2,"mimeType":"image/png"})", picture("rgba.png"))));
}

TEST(MeshPictures, OfAGltfComeFromADataUri)
{
    expect_textured(import(
        "a.gltf",
        gltf_with(
            kTextured, R"({"uri":"data:image/png;base64,)" + base64(picture("rgba.png")) + R"("})", "1234")));
}

TEST(MeshPictures, OfAGltfComeFromFilesBesideIt)
{
    expect_textured(import("a.gltf",
                           gltf_with(kTextured, R"({"uri":"maps/leaf.png"})", "1234"),
                           {{"maps/leaf.png", picture("rgba.png")}}));
}

// The first row of a picture is at v = 0 there, and at v = 1 here.
TEST(MeshPictures, OfAGltfStandTheRightWayUp)
{
    const ImportedMesh mesh = import("a.gltf", gltf_with(kTextured, R"({"uri":"gone.png"})", "1234"));
    ASSERT_EQ(mesh.mesh.uvs.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(mesh.mesh.uvs[i].y, 1 - mesh.mesh.positions[i].y);
}

} // namespace
