#include "renderer/geometry/validate_mesh.h"
#include "renderer/io/import_mesh.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace {

using renderer::ImportedMesh;
using renderer::ImportFault;
using renderer::Limits;

using Files = std::map<std::string, std::string, std::less<>>;

std::span<const std::byte> bytes_in(const std::string& text)
{
    return std::as_bytes(std::span(text));
}

renderer::OpenFile serve(const Files& files)
{
    return [&files](std::string_view name) -> std::optional<std::span<const std::byte>> {
        const auto file = files.find(name);
        if (file == files.end()) return std::nullopt;
        return bytes_in(file->second);
    };
}

renderer::ImportResult import_text(const std::string& name,
                                   const std::string& text,
                                   const Files& files = {},
                                   const Limits& limits = {})
{
    return renderer::import_mesh(name, bytes_in(text), serve(files), limits);
}

ImportedMesh imported(const std::string& name, const std::string& text, const Files& files = {})
{
    auto result = import_text(name, text, files);
    if (auto* fault = std::get_if<ImportFault>(&result)) {
        ADD_FAILURE() << name << ": " << fault->code << ": " << fault->detail;
        return {};
    }
    return std::move(std::get<ImportedMesh>(result));
}

std::string asset(const std::string& name)
{
    return tests::bytes_of(std::filesystem::path(tests::asset_dir()) / name);
}

TEST(ImportMesh, ReadsTheSameKnotFromEveryFormat)
{
    const ImportedMesh obj = imported("knot.obj", asset("knot.obj"));
    EXPECT_EQ(obj.format, "obj");
    EXPECT_EQ(obj.mesh.triangles.size(), 6144u);
    EXPECT_EQ(obj.mesh.normals.size(), obj.mesh.positions.size());
    EXPECT_EQ(obj.mesh.uvs.size(), obj.mesh.positions.size());
    const Files buffers{{"knot.bin", asset("knot.bin")}};
    for (const std::string name :
         {"knot.ply", "knot_ascii.ply", "knot.stl", "knot_ascii.stl", "knot.glb", "knot.gltf"}) {
        const ImportedMesh other = imported(name, asset(name), buffers);
        EXPECT_EQ(other.mesh.triangles.size(), 6144u) << name;
        ASSERT_FALSE(other.mesh.triangles.empty());
        // The same triangles in the same order, whatever the numbers of their vertices.
        for (std::size_t t = 0; t < 6144; ++t)
            for (std::size_t i = 0; i < 3; ++i) {
                const auto a = obj.mesh.positions[obj.mesh.triangles[t][i]];
                const auto b = other.mesh.positions[other.mesh.triangles[t][i]];
                ASSERT_LE(max_component(abs(a - b)), 1e-6f) << name << " triangle " << t;
            }
        EXPECT_EQ(other.mesh.normals.empty(), name.ends_with(".stl")) << name;
        for (std::size_t v = 0; v < other.mesh.normals.size(); ++v)
            ASSERT_NEAR(length(other.mesh.normals[v]), 1, 1e-5) << name;
    }
}

TEST(ImportMesh, ReadsPlyStripsAsTheTrianglesTheyStandFor)
{
    const ImportedMesh strips = imported("strips.ply", asset("strips.ply"));
    // Wound outwards everywhere: the volume is that of the sphere, all of it positive.
    double volume = 0;
    for (const auto& t : strips.mesh.triangles) {
        const auto a = to_double(strips.mesh.positions[t[0]]), b = to_double(strips.mesh.positions[t[1]]),
                   c = to_double(strips.mesh.positions[t[2]]);
        const double piece = dot(a, cross(b, c)) / 6;
        EXPECT_GE(piece, -1e-12);
        volume += piece;
    }
    EXPECT_NEAR(volume, 4.0 / 3 * 3.14159265 * 0.125, 0.01);
}

TEST(ImportMesh, TellsTheFormatFromTheContentBeforeTheName)
{
    EXPECT_EQ(imported("knot.obj", asset("knot.ply")).format, "ply");
    EXPECT_EQ(imported("knot.ply", asset("knot.stl")).format, "stl");
    EXPECT_EQ(imported("knot", asset("knot_ascii.stl")).format, "stl");
    EXPECT_EQ(imported("knot.stl", asset("knot.obj")).format, "obj");
    EXPECT_EQ(imported("knot.obj", asset("knot.glb")).format, "glb");
    EXPECT_EQ(imported("", asset("knot.gltf"), {{"knot.bin", asset("knot.bin")}}).format, "gltf");
}

TEST(ImportMesh, ReadsABinaryStlWhoseHeaderBeginsWithSolid)
{
    std::string stl = asset("knot.stl");
    stl.replace(0, 11, "solid facet");
    EXPECT_EQ(imported("knot.stl", stl).mesh.triangles.size(), 6144u);
}

TEST(ImportMesh, ReadsAnAsciiStlInCapitals)
{
    std::string stl = asset("knot_ascii.stl");
    const std::size_t triangles = imported("knot_ascii.stl", stl).mesh.triangles.size();
    for (char& c : stl)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(imported("mesh", stl).mesh.triangles.size(), triangles);
    EXPECT_EQ(imported("mesh.stl", stl).mesh.triangles.size(), triangles);
}

TEST(ImportMesh, NamesWhatItReadsWhenItKnowsNothingOfAFile)
{
    const auto result = import_text("holiday.jpg", std::string("\xff\xd8\xff\xe0 JFIF"));
    ASSERT_TRUE(std::holds_alternative<ImportFault>(result));
    const auto& fault = std::get<ImportFault>(result);
    EXPECT_EQ(fault.code, "unknown_format");
    for (const char* format : {"OBJ", "PLY", "STL", "glTF", "GLB"})
        EXPECT_THAT(fault.detail, testing::HasSubstr(format));
}

TEST(ImportMesh, RefusesMoreTrianglesThanTheLimit)
{
    Limits limits;
    limits.triangles = 6143;
    for (const char* name :
         {"knot.obj", "knot.ply", "knot_ascii.ply", "knot.stl", "knot_ascii.stl", "knot.glb"}) {
        const auto result = import_text(name, asset(name), {}, limits);
        ASSERT_TRUE(std::holds_alternative<ImportFault>(result)) << name;
        EXPECT_EQ(std::get<ImportFault>(result).code, "over_limit") << name;
        EXPECT_THAT(std::get<ImportFault>(result).detail, testing::HasSubstr("6143")) << name;
        EXPECT_THAT(std::get<ImportFault>(result).detail, testing::HasSubstr("--limit-triangles")) << name;
    }
}

TEST(ImportMesh, RefusesEveryBrokenFileWithOneOfItsCodes)
{
    std::istringstream manifest(asset("broken/manifest.tsv"));
    int files = 0;
    for (std::string line; std::getline(manifest, line); ++files) {
        std::istringstream fields(line);
        std::string name, codes, what;
        std::getline(std::getline(std::getline(fields, name, '\t'), codes, '\t'), what);
        const auto result = import_text(name, asset("broken/" + name));
        const auto* fault = std::get_if<ImportFault>(&result);
        const std::string code = fault ? fault->code : "ok";
        EXPECT_NE(("," + codes + ",").find("," + code + ","), std::string::npos)
            << name << " (" << what << ") gave " << code << ": " << (fault ? fault->detail : "");
        if (fault) {
            EXPECT_GT(fault->detail.size(), 10u) << name;
            EXPECT_LT(fault->detail.size(), 500u) << name;
        } else {
            EXPECT_FALSE(renderer::validate_mesh(std::get<ImportedMesh>(result).mesh)) << name;
        }
    }
    EXPECT_GT(files, 50);
}

TEST(ImportMesh, AsksForNoNameThatCouldLeadElsewhere)
{
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::vector<std::string> asked;
    const renderer::OpenFile note = [&](std::string_view name) -> std::optional<std::span<const std::byte>> {
        asked.emplace_back(name);
        return std::nullopt;
    };
    const std::string obj =
        "mtllib ../../etc/passwd\nmtllib /etc/passwd\nmtllib a/../../b.mtl\nmtllib C:\\x.mtl\n"
        "mtllib file:///etc/passwd\nmtllib good.mtl\n" +
        triangle;
    const auto result = renderer::import_mesh("x.obj", bytes_in(obj), note, {});
    EXPECT_TRUE(std::holds_alternative<ImportedMesh>(result));
    EXPECT_THAT(asked, testing::Each("good.mtl"));
    EXPECT_EQ(std::get<ImportedMesh>(result).opened_files.size(), 0u);

    asked.clear();
    for (const std::string uri :
         {"../../../../etc/passwd", "/etc/passwd", "file:///etc/passwd", "http://127.0.0.1:9/x"}) {
        std::string gltf = asset("knot.gltf");
        gltf.replace(gltf.find("knot.bin"), 8, uri);
        const auto refused = renderer::import_mesh("x.gltf", bytes_in(gltf), note, {});
        ASSERT_TRUE(std::holds_alternative<ImportFault>(refused)) << uri;
        EXPECT_EQ(std::get<ImportFault>(refused).code, "missing_file") << uri;
    }
    for (const std::string& name : asked) {
        EXPECT_EQ(name.find(".."), std::string::npos) << name;
        EXPECT_NE(name.front(), '/') << name;
        EXPECT_EQ(name.find(':'), std::string::npos) << name;
    }
}

struct RealMesh {
    const char* name;
    std::size_t triangles, vertices;
    renderer::Bounds3f bounds;
};

TEST(ImportMesh, ReadsRealMeshesWithTheirTrueCountsAndBounds)
{
    const std::filesystem::path folder = std::filesystem::path(tests::source_dir()) / "../shared/assets";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the real meshes are not here";
    const RealMesh meshes[]{
        {"bunny.obj", 69451, 34834, {{-0.09469f, 0.032987f, -0.061874f}, {0.061009f, 0.187321f, 0.0588f}}},
        {"sponza.obj", 66454, 0, {{-17.40276f, -0.906689f, -7.798512f}, {17.41724f, 15.653312f, 7.801489f}}},
        {"nefertiti.obj",
         99938,
         49971,
         {{-119.322998f, -181.292999f, -247.268005f}, {119.362999f, 181.240997f, 247.337006f}}},
        {"ogre.obj", 124008, 62194, {{-15.61f, -0.008192f, -5.456f}, {15.61f, 32.03f, 4.267f}}},
        {"museum.ply",
         892199,
         447966,
         {{-17.40276f, -0.906689f, -7.798512f}, {17.41724f, 15.653312f, 7.801489f}}},
        {"igea.ply", 268686, 134345, {}},
    };
    for (const RealMesh& real : meshes) {
        const ImportedMesh result = imported(real.name, tests::bytes_of(folder / real.name));
        EXPECT_EQ(result.mesh.triangles.size(), real.triangles) << real.name;
        if (real.vertices) { // Sponza's are more than its README's: they have normals too
            EXPECT_EQ(result.mesh.positions.size(), real.vertices) << real.name;
        }
        const renderer::Bounds3f bounds = result.mesh.bounds();
        if (real.bounds.empty()) continue;
        EXPECT_EQ(bounds.lower, real.bounds.lower) << real.name;
        EXPECT_EQ(bounds.upper, real.bounds.upper) << real.name;
    }
}

TEST(ImportMesh, RefusesTheKnownBombsQuicklyAndClearly)
{
    const std::filesystem::path folder =
        std::filesystem::path(tests::source_dir()) / "../shared/kit/prototypes/hostile";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "the hostile files are not here; broken/ has our own";
    for (const auto& [name, code] : std::map<std::string, std::string>{{"dag.gltf", "malformed"},
                                                                       {"t.gltf", "missing_file"},
                                                                       {"lie.hdr", "unknown_format"},
                                                                       {"lie.ppm", "unknown_format"}}) {
        const auto result = import_text(name, tests::bytes_of(folder / name));
        ASSERT_TRUE(std::holds_alternative<ImportFault>(result)) << name;
        EXPECT_EQ(std::get<ImportFault>(result).code, code)
            << name << ": " << std::get<ImportFault>(result).detail;
    }
}

// Whatever byte is wrong or missing, the answer is a sound mesh or a fault; under asan this also finds reads
// out of bounds.
TEST(ImportMesh, SurvivesBytesThatAreWrongOrMissing)
{
    std::uint64_t state = 0x2545f4914f6cdd1du;
    const auto random = [&] {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        return state;
    };
    const std::string obj =
        "mtllib a.mtl\no x\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 2\nvt 0 1\nvn 0 0 1\n"
        "f 1/1/1 2//1 3/1 4\ng y\nf -1 -2 -3 -4 -5\nl 1 2\n";
    const Files files{{"a.mtl", "newmtl a\nKd 1 0 0\nKs 0.5\nNs 10\nmap_Kd -s 1 1 1 a b.png\n"}};
    const std::string broken = "broken/";
    for (const std::string& seed : {obj,
                                    asset("strips.ply").substr(0, 600),
                                    asset("broken/index_too_large.ply"),
                                    asset("broken/no_triangles_ascii.stl") +
                                        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"})
        for (int round = 0; round < 3000; ++round) {
            std::string bytes = seed.substr(0, round % 3 ? seed.size() : random() % (seed.size() + 1));
            for (std::uint64_t edits = random() % 4; edits-- > 0 && !bytes.empty();)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            const auto result = import_text(round % 2 ? "x.obj" : "x.stl", bytes, files);
            if (const auto* mesh = std::get_if<ImportedMesh>(&result)) {
                ASSERT_FALSE(renderer::validate_mesh(mesh->mesh));
            }
        }
}

} // namespace
