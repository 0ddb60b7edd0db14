#include "renderer/io/gltf_buffers.h"
#include "renderer/io/gltf_emission.h"
#include "renderer/io/gltf_outline.h"
#include "renderer/io/gltf_tree.h"
#include "renderer/io/import_mesh.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using renderer::ImportedMesh;
using renderer::ImportFault;

renderer::ImportResult import_text(const std::string& name, const std::string& text)
{
    return renderer::import_mesh(name, std::as_bytes(std::span(text)), {}, {});
}

std::string fault_code(const std::string& json)
{
    const auto outline = renderer::read_gltf_outline(json);
    if (const auto* fault = std::get_if<ImportFault>(&outline)) return fault->code;
    const auto fault = renderer::check_gltf_tree(std::get<renderer::GltfOutline>(outline));
    return fault ? fault->code : "none";
}

std::string with_nodes(const std::string& nodes, const std::string& roots = "0")
{
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes + "]}";
}

// One triangle in a data: URI. `node` and `primitive` are further members, each with a comma before it;
// `more` likewise of the file.
std::string
triangle_gltf(const std::string& node, const std::string& primitive = "", const std::string& more = "")
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"mesh":0)" +
           node + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0})" + primitive + R"(}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}])" +
           more + "}";
}

TEST(ReadGltf, PlacesEveryNodeWithinItsParentAndKeepsSubtreesTogether)
{
    const auto result = import_text("parts.glb", tests::bytes_of(tests::asset_dir() + "/parts.glb"));
    ASSERT_TRUE(std::holds_alternative<ImportedMesh>(result)) << std::get<ImportFault>(result).detail;
    const renderer::Mesh& mesh = std::get<ImportedMesh>(result).mesh;
    std::vector<std::string> names;
    for (const auto& part : mesh.parts)
        names.push_back(part.name);
    EXPECT_THAT(names, testing::IsSupersetOf({"base", "arm", "hand", "tip"}));
    const auto part = [&](const std::string& name) {
        return *std::find_if(
            mesh.parts.begin(), mesh.parts.end(), [&](const auto& p) { return p.name == name; });
    };
    EXPECT_EQ(part("base").triangle_count, 12u);
    EXPECT_EQ(part("tip").triangle_count, 12u);
    EXPECT_EQ(part("arm").triangle_count, part("hand").triangle_count);
    EXPECT_EQ(part("hand").first_triangle + part("hand").triangle_count, part("tip").first_triangle + 12);
    // tip: a box of 1 x 0.2 x 1 turned by 90 degrees about z, 2 up in hand, which is halved and at (0.5, 1,
    // 0).
    renderer::Bounds3f bounds;
    for (std::uint32_t t = part("tip").first_triangle; t < part("tip").first_triangle + 12; ++t)
        for (const auto vertex : mesh.triangles[t])
            bounds.extend(mesh.positions[vertex]);
    EXPECT_NEAR(bounds.lower.x, 0.45, 1e-6);
    EXPECT_NEAR(bounds.upper.x, 0.55, 1e-6);
    EXPECT_NEAR(bounds.lower.y, 1.75, 1e-6);
    EXPECT_NEAR(bounds.upper.y, 2.25, 1e-6);
    EXPECT_NEAR(bounds.lower.z, -0.25, 1e-6);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const auto& n : mesh.normals)
        EXPECT_NEAR(length(n), 1, 1e-5);
}

TEST(ReadGltf, TakesBaseColoursAsDiffuse)
{
    const auto result = import_text("parts.glb", tests::bytes_of(tests::asset_dir() + "/parts.glb"));
    ASSERT_TRUE(std::holds_alternative<ImportedMesh>(result));
    const renderer::Mesh& mesh = std::get<ImportedMesh>(result).mesh;
    ASSERT_GE(mesh.materials.size(), 2u);
    EXPECT_EQ(mesh.materials[0].diffuse, (renderer::Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(mesh.materials[1].diffuse, (renderer::Rgb{0.2f, 0.5f, 0.8f}));
    ASSERT_EQ(mesh.triangle_materials.size(), mesh.triangles.size());
}

// By a node of negative scale: the winding must turn with it.
TEST(ReadGltf, TurnsTheWindingOfMirroredNodesAndReadsDataUris)
{
    const std::string json = triangle_gltf(R"(,"scale":[-1,1,1])");
    const auto result = import_text("t.gltf", json);
    ASSERT_TRUE(std::holds_alternative<ImportedMesh>(result)) << std::get<ImportFault>(result).detail;
    const renderer::Mesh& mesh = std::get<ImportedMesh>(result).mesh;
    ASSERT_EQ(mesh.triangles.size(), 1u);
    const auto corner = [&](std::size_t i) { return to_double(mesh.positions[mesh.triangles[0][i]]); };
    EXPECT_EQ(corner(0), (renderer::Vec3d{0, 0, 0}));
    EXPECT_EQ(cross(corner(1) - corner(0), corner(2) - corner(0)), (renderer::Vec3d{0, 0, 1}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.materials.empty());
}

// e emits, t transparent, m metal, r roughness: of the first material, of one triangle.
std::string traits_of(const std::string& material)
{
    const auto result =
        import_text("t.gltf", triangle_gltf("", R"(,"material":0)", R"(,"materials":[{)" + material + "}]"));
    if (const auto* fault = std::get_if<ImportFault>(&result)) return fault->detail;
    const auto& materials = std::get<ImportedMesh>(result).mesh.materials;
    if (materials.empty()) return "none";
    const renderer::MeshMaterial& m = materials[0];
    return std::string(m.emits ? "e" : "") + (m.is_transparent ? "t" : "") + (m.is_metal ? "m" : "") +
           (m.has_roughness ? "r" : "");
}

TEST(ReadGltf, KeepsWhatItsMaterialsHaveThatIsNotModelled)
{
    const auto with = [](const std::string& pbr, const std::string& more = "") {
        return traits_of("\"pbrMetallicRoughness\":{" + pbr + "}" + more);
    };
    const std::string plain = R"("metallicFactor":0)";
    EXPECT_EQ(with(plain), "");
    EXPECT_EQ(with(""), "m") << "the format's default is metal";
    EXPECT_EQ(with(R"("metallicFactor":0.5,"roughnessFactor":0.2)"), "mr");
    EXPECT_EQ(with(plain, R"(,"emissiveFactor":[0,0,0.1])"), "") << "it shines";
    const std::string thin = plain + R"(,"baseColorFactor":[1,1,1,0.4])";
    EXPECT_EQ(with(thin, R"(,"alphaMode":"BLEND")"), "t");
    EXPECT_EQ(with(thin, R"(,"alphaMode":"MASK")"), "t");
    EXPECT_EQ(with(thin), "") << "alphaMode OPAQUE ignores alpha";
    EXPECT_EQ(with(plain, R"(,"alphaMode":"BLEND")"), "") << "nothing of it is transparent";
}

TEST(ReadGltf, TakesTheEmissionOfItsMaterials)
{
    const auto emission = [](const std::string& material) {
        const auto result = import_text(
            "t.gltf", triangle_gltf("", R"(,"material":0)", R"(,"materials":[{)" + material + "}]"));
        EXPECT_TRUE(std::holds_alternative<ImportedMesh>(result)) << std::get<ImportFault>(result).detail;
        return std::get<ImportedMesh>(result).mesh.materials.at(0).emission;
    };
    EXPECT_EQ(emission(R"("name":"b")"), renderer::Rgb{});
    EXPECT_EQ(emission(R"("name":"b","emissiveFactor":[1,0.5,0.25])"), (renderer::Rgb{1, 0.5f, 0.25f}));
}

// `buffer`: of a length that 4 divides.
std::string glb(std::string json, const std::string& buffer)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t number) {
        std::string bytes;
        for (unsigned shift = 0; shift < 32; shift += 8)
            bytes += static_cast<char>(number >> shift & 0xff);
        return bytes;
    };
    return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + buffer.size()) + word(json.size()) + "JSON" +
           json + word(buffer.size()) + std::string("BIN\0", 4) + buffer;
}

// Two triangles; the second material of the file is used first, and one that nobody uses stands before both.
std::string two_lamps(const std::string& buffer)
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":1},{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":1}]},
                  {"primitives":[{"attributes":{"POSITION":0},"material":2}]}],
        "materials":[
            {"name":"idle","emissiveFactor":[1,1,1],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":9}}},
            {"name":"lamp","extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4.5}},
             "emissiveFactor": [
                 1.0,
                 0.5, 0
             ]},
            {"name":"lamp","emissiveFactor":[0.25,0.25,1],"extensions":{"KHR_materials_emissive_strength":{}}}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{)" +
           buffer + R"("byteLength":36}],"extensionsUsed":["KHR_materials_emissive_strength"]})";
}

// Of the material that each triangle has.
std::vector<renderer::Rgb> emissions_of(const std::string& name, const std::string& bytes)
{
    const auto result = import_text(name, bytes);
    EXPECT_TRUE(std::holds_alternative<ImportedMesh>(result)) << std::get<ImportFault>(result).detail;
    const renderer::Mesh& mesh = std::get<ImportedMesh>(result).mesh;
    std::vector<renderer::Rgb> emissions;
    for (const std::uint16_t material : mesh.triangle_materials)
        emissions.push_back(mesh.materials.at(material).emission);
    return emissions;
}

TEST(ReadGltf, MultipliesEmissionByTheStrengthOfItsOwnMaterial)
{
    const std::vector<renderer::Rgb> want{{0.25f, 0.25f, 1}, {4.5f, 2.25f, 0}};
    EXPECT_EQ(
        emissions_of(
            "t.gltf",
            two_lamps(
                R"("uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA",)")),
        want);
    std::string corners(36, '\0');
    for (const std::size_t at : {12u, 28u})
        corners.replace(at, 4, std::string("\0\0\x80\x3f", 4));
    EXPECT_EQ(emissions_of("t.glb", glb(two_lamps(""), corners)), want);
}

// A tetrahedron of one material.
std::string tetrahedron_glb(const std::string& material)
{
    const std::string json =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
        "materials":[{"name":"m",)" +
        material + R"(}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
                     {"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
        "buffers":[{"byteLength":60}],
        "extensionsUsed":["KHR_materials_transmission","KHR_materials_volume","KHR_materials_ior"]})";
    std::string bytes(48, '\0');
    for (const std::size_t at : {12u, 28u, 44u})
        bytes.replace(at, 4, std::string("\0\0\x80\x3f", 4));
    bytes += std::string("\0\2\1\0\1\3\0\3\2\1\2\3", 12);
    return glb(json, bytes);
}

renderer::MeshMaterial glass_of(const std::string& factors, const std::string& extensions)
{
    const auto result = import_text(
        "t.glb",
        tetrahedron_glb("\"pbrMetallicRoughness\":{" + factors + "},\"extensions\":{" + extensions + "}"));
    EXPECT_TRUE(std::holds_alternative<ImportedMesh>(result)) << std::get<ImportFault>(result).detail;
    return std::get<ImportedMesh>(result).mesh.materials.at(0);
}

TEST(ReadGltf, TakesTransmittingBodiesThatHaveAVolumeAsGlass)
{
    const std::string factors =
                          R"("metallicFactor":0,"roughnessFactor":0.25,"baseColorFactor":[0.5,1,0.25,1])",
                      transmission = R"("KHR_materials_transmission":{"transmissionFactor":1})";
    const renderer::MeshMaterial glass = glass_of(
        factors,
        transmission +
            R"(,"KHR_materials_ior":{"ior":1.33},"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":2,)"
            R"("attenuationColor":[1,0.5,0.25]})");
    EXPECT_TRUE(glass.is_glass);
    EXPECT_FALSE(glass.is_transparent);
    EXPECT_FLOAT_EQ(glass.ior, 1.33f);
    EXPECT_FLOAT_EQ(glass.roughness, 0.25f);
    EXPECT_EQ(glass.transmission, (renderer::Rgb{0.5f, 1, 0.25f}));
    EXPECT_EQ(glass.absorption.r, 0);
    EXPECT_NEAR(glass.absorption.g, std::log(2.0) / 2, 1e-6);
    EXPECT_NEAR(glass.absorption.b, std::log(4.0) / 2, 1e-6);

    const std::string volume = R"(,"KHR_materials_volume":{"thicknessFactor":0.1})";
    const renderer::MeshMaterial plain = glass_of(factors, transmission + volume);
    EXPECT_TRUE(plain.is_glass);
    EXPECT_FLOAT_EQ(plain.ior, 1.5f);
    EXPECT_EQ(plain.absorption, renderer::Rgb{});
    for (const renderer::MeshMaterial& opaque :
         {glass_of(factors, transmission),
          glass_of(R"("metallicFactor":1)", transmission + volume),
          glass_of(factors, R"("KHR_materials_transmission":{"transmissionFactor":0.25})" + volume)}) {
        EXPECT_FALSE(opaque.is_glass);
        EXPECT_TRUE(opaque.is_transparent) << "which is told";
    }
    EXPECT_FALSE(glass_of(factors, R"("KHR_materials_ior":{"ior":1.2})").is_glass);

    std::string sheet =
        triangle_gltf("",
                      R"(,"material":0)",
                      R"(,"extensionsUsed":["KHR_materials_transmission","KHR_materials_volume"],)"
                      R"("materials":[{"name":"pane","extensions":{)" +
                          transmission + volume + "}," + R"("pbrMetallicRoughness":{)" + factors + "}}]");
    const auto result = import_text("t.gltf", sheet);
    ASSERT_TRUE(std::holds_alternative<ImportedMesh>(result)) << std::get<ImportFault>(result).detail;
    EXPECT_FALSE(std::get<ImportedMesh>(result).mesh.materials.at(0).is_glass);
    EXPECT_THAT(std::get<ImportedMesh>(result).notes,
                testing::Contains(testing::HasSubstr("\"pane\" is of glass")));
}

TEST(GltfEmission, LeavesAloneWhatItNeedNotChange)
{
    const auto scaled = [](const std::string& material) {
        return renderer::with_emissive_strength("{\"materials\":[{" + material + "}]}").value_or("none");
    };
    const std::string factor = R"("emissiveFactor":[1,2,3])";
    const auto strength = [](const std::string& value) {
        return R"(,"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":)" + value + "}}";
    };
    EXPECT_EQ(scaled(factor + strength("2")),
              R"({"materials":[{"emissiveFactor":[2,4,6])" + strength("2") + "}]}");
    EXPECT_NE(scaled(factor + strength("2e38")).find("3.40282347e+38"), std::string::npos);
    for (const std::string& material : {factor,
                                        factor + strength("1"),
                                        factor + strength("-2"),
                                        factor + strength("\"2\""),
                                        R"("name":"x")" + strength("2"),
                                        R"("emissiveFactor":[1,2])" + strength("2"),
                                        R"("emissiveFactor":[1,2,3,4])" + strength("2"),
                                        R"("emissiveFactor":5)" + strength("2")})
        EXPECT_EQ(scaled(material), "none") << material;
    for (const char* json : {"", "{", "[]", R"({"materials":{}})", R"({"materials":[1]})"})
        EXPECT_FALSE(renderer::with_emissive_strength(json)) << json;
}

TEST(GltfOutline, RefusesNodesThatAreNoTrees)
{
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[1,2]},{},{})")), "none");
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[1,1]},{})")), "malformed");
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[2]},{"children":[2]},{})", "0,1")), "malformed");
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[1]},{"children":[0]})")), "malformed");
    EXPECT_EQ(fault_code(with_nodes(R"({},{"children":[1]})")), "over_limit");
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[7]})")), "malformed");
    EXPECT_EQ(fault_code(with_nodes("{}", "0,0")), "malformed");
    EXPECT_EQ(fault_code(with_nodes("{}", "3")), "malformed");
}

TEST(GltfOutline, RefusesChainsThatAreTooDeep)
{
    const auto chain = [](int nodes) {
        std::string text;
        for (int i = 1; i < nodes; ++i)
            text += "{\"children\":[" + std::to_string(i) + "]},";
        return with_nodes(text + "{}");
    };
    EXPECT_EQ(fault_code(chain(256)), "none");
    EXPECT_EQ(fault_code(chain(257)), "over_limit");
    EXPECT_EQ(fault_code(chain(100'000)), "over_limit");
}

TEST(GltfOutline, RefusesWhatAssimpMightUnderstandOtherwise)
{
    EXPECT_EQ(fault_code(R"({"asset":{"version":"2.0"},"nodes":[],"nodes":[{"children":[0]}]})"),
              "malformed");
    EXPECT_EQ(fault_code(R"({"asset":{"version":"2.0"},"n\u006fdes":[{"children":[0]}]})"), "malformed");
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[1],"children":[1]},{})")), "malformed");
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[1.0]},{})")), "malformed");
    EXPECT_EQ(fault_code(with_nodes(R"({"children":[-1]},{})")), "malformed");
    EXPECT_EQ(fault_code(with_nodes("{}") + "x"), "malformed");
    EXPECT_EQ(fault_code(R"({"asset":{"version":"1.0"}})"), "unsupported");
    EXPECT_EQ(
        fault_code(R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]})"),
        "unsupported");
    EXPECT_EQ(fault_code(R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_materials_unlit"]})"),
              "none");
    EXPECT_EQ(fault_code("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + std::string(100'000, '[')),
              "malformed");
    EXPECT_EQ(fault_code(R"({"asset":{"version":"2.0")"), "truncated");
}

} // namespace
