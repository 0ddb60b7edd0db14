// What GET /v1/capabilities names as mesh formats, held against what the importer reads.
#include "api/documents.h"
#include "renderer/io/import_mesh.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace {

const std::map<std::string, std::string> kTriangles{
    {"obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
    {"ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
    {"stl",
     "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
     "endfacet\nendsolid t\n"},
    {"gltf",
     R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
      "bufferViews":[{"buffer":0,"byteLength":36}],
      "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})"}};

// The glTF text as a GLB of one JSON chunk.
std::string glb_of(std::string json)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t value) {
        const auto narrow = static_cast<std::uint32_t>(value);
        std::string bytes(4, '\0');
        std::memcpy(bytes.data(), &narrow, 4);
        return bytes;
    };
    return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
}

TEST(Capabilities, NameExactlyTheMeshFormatsThatAreRead)
{
    std::map<std::string, std::string> files = kTriangles;
    files["glb"] = glb_of(kTriangles.at("gltf"));
    for (const char* format : {"fbx", "dae", "3ds", "off"})
        files[format] =
            tests::bytes_of(std::filesystem::path(tests::asset_dir()) / (std::string("knot.") + format));
    std::vector<std::string> read;
    for (const auto& [format, text] : files) {
        const auto result = renderer::import_mesh("triangle." + format,
                                                  std::as_bytes(std::span(text.data(), text.size())),
                                                  [](std::string_view) { return std::nullopt; },
                                                  {});
        const auto* mesh = std::get_if<renderer::ImportedMesh>(&result);
        ASSERT_NE(mesh, nullptr) << format << ": " << std::get<renderer::ImportFault>(result).detail;
        EXPECT_EQ(mesh->format, format);
        EXPECT_GT(mesh->mesh.triangles.size(), 0U) << format;
        read.push_back(mesh->format);
    }
    auto told = nlohmann::json::parse(api::write_capabilities({}))["formats"]["meshes"]
                    .get<std::vector<std::string>>();
    std::sort(told.begin(), told.end());
    std::sort(read.begin(), read.end());
    EXPECT_EQ(told, read);
    auto documented =
        nlohmann::json::parse(api::openapi_json())
            .at("/components/schemas/AssetInfo/properties/mesh/properties/format/enum"_json_pointer)
            .get<std::vector<std::string>>();
    std::sort(documented.begin(), documented.end());
    EXPECT_EQ(documented, read);
}

} // namespace
