#include "renderer/io/read_obj.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

namespace {

using renderer::ImportedMesh;
using renderer::ImportFault;
using renderer::Mesh;

using Files = std::map<std::string, std::string, std::less<>>;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

renderer::ImportResult
read(const std::string& text, const Files& files = {}, const renderer::Limits& limits = {})
{
    const renderer::OpenFile open = [&](std::string_view name) -> std::optional<std::span<const std::byte>> {
        const auto file = files.find(name);
        if (file == files.end()) return std::nullopt;
        return std::as_bytes(std::span(file->second));
    };
    renderer::CompanionFiles companions(open);
    return renderer::read_obj(text, companions, limits);
}

ImportedMesh mesh_of(const std::string& text, const Files& files = {})
{
    auto result = read(text, files);
    if (const auto* fault = std::get_if<ImportFault>(&result))
        ADD_FAILURE() << fault->code << ": " << fault->detail;
    return std::holds_alternative<ImportedMesh>(result) ? std::get<ImportedMesh>(std::move(result))
                                                        : ImportedMesh();
}

ImportFault fault_of(const std::string& text)
{
    auto result = read(text);
    return std::holds_alternative<ImportFault>(result) ? std::get<ImportFault>(std::move(result))
                                                       : ImportFault{"none", ""};
}

double area(const Mesh& mesh)
{
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const auto a = to_double(mesh.positions[t[0]]);
        sum += length(cross(to_double(mesh.positions[t[1]]) - a, to_double(mesh.positions[t[2]]) - a)) / 2;
    }
    return sum;
}

TEST(ReadObj, KeepsOneVertexForEveryUsedCornerAndDropsTheRest)
{
    const Mesh mesh = mesh_of("v 9 9 9\n" + kSquare + "f 2 3 4\nf 2 4 5\n").mesh;
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.triangles, (std::vector<renderer::Triangle>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_TRUE(mesh.uvs.empty());
}

TEST(ReadObj, TriangulatesPolygonsInsideTheirOutline)
{
    // An L of area 3 whose fan from the first corner would cover more.
    const std::string corners = "v 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\n";
    for (const std::string face : {"f 1 2 3 4 5 6\n", "f 4 5 6 1 2 3\n", "f 6 5 4 3 2 1\n"}) {
        const Mesh mesh = mesh_of(corners + face).mesh;
        EXPECT_EQ(mesh.triangles.size(), 4u);
        EXPECT_NEAR(area(mesh), 3, 1e-12) << face;
    }
}

TEST(ReadObj, CountsNegativeIndicesFromTheLastVertex)
{
    EXPECT_EQ(mesh_of(kSquare + "f -4 -3 -2\nv 5 5 5\n").mesh.positions[2], (renderer::Vec3f{1, 1, 0}));
}

TEST(ReadObj, AllowsFacesBeforeTheirVertices)
{
    EXPECT_EQ(mesh_of("f 1 2 3\n" + kSquare).mesh.triangles.size(), 1u);
}

TEST(ReadObj, KeepsCornersApartWhoseNormalsDiffer)
{
    const Mesh mesh = mesh_of(kSquare + "vn 0 0 2\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1//2 3//1 4//1\n").mesh;
    EXPECT_EQ(mesh.positions.size(), 5u);
    ASSERT_EQ(mesh.normals.size(), 5u);
    EXPECT_EQ(mesh.normals[0], (renderer::Vec3f{0, 0, 1})); // brought to length 1
}

TEST(ReadObj, GivesFacesWithoutNormalsTheirOwnWhereOthersHaveThem)
{
    const Mesh mesh =
        mesh_of(kSquare + "v 0 0 1\nvn 0 0 1\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1 5 4\nf 1//2 3//2 4//2\n").mesh;
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const std::uint32_t vertex : mesh.triangles[1])
        EXPECT_EQ(mesh.normals[vertex], (renderer::Vec3f{-1, 0, 0}));
    for (const std::uint32_t vertex : mesh.triangles[2])
        EXPECT_EQ(mesh.normals[vertex], (renderer::Vec3f{0, 0, 1}));
}

TEST(ReadObj, LeavesOutLinesAndPointsAndSaysSo)
{
    const ImportedMesh result = mesh_of(kSquare + "l 1 2 3\np 1\nf 1 2\nf 1 2 3\n");
    EXPECT_EQ(result.mesh.triangles.size(), 1u);
    EXPECT_THAT(result.notes, testing::ElementsAre(testing::HasSubstr("3 lines and points")));
}

TEST(ReadObj, TakesMaterialsFromItsMtl)
{
    const Files files{{"my mats.mtl",
                       "newmtl red\nKd 1 0 0\nKs 0.5\nNs 32\nmap_Kd -s 2 2 -o 0.5 wood grain.png\nnewmtl "
                       "blue\nKd 0 0 7\n"}};
    const ImportedMesh result =
        mesh_of("mtllib my mats.mtl\n" + kSquare +
                    "f 1 2 3\nusemtl blue\nf 1 3 4\nusemtl red\nf 1 2 4\nusemtl gone\nf 2 3 4\n",
                files);
    ASSERT_EQ(result.mesh.materials.size(), 3u);
    EXPECT_EQ(result.mesh.materials[0].diffuse, (renderer::Rgb{1, 0, 0}));
    EXPECT_EQ(result.mesh.materials[0].specular, (renderer::Rgb{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(result.mesh.materials[0].shininess, 32);
    EXPECT_THAT(result.mesh.materials[0].textures, testing::ElementsAre("wood grain.png"));
    EXPECT_EQ(result.mesh.materials[1].diffuse, (renderer::Rgb{0, 0, 1})); // within [0, 1]
    EXPECT_THAT(result.mesh.triangle_materials, testing::ElementsAre(2, 1, 0, 2));
    EXPECT_THAT(result.notes,
                testing::ElementsAre(testing::HasSubstr("wood grain.png did not come"),
                                     testing::HasSubstr("\"gone\"")));
}

TEST(ReadObj, ReadsAnMtlOnceHoweverOftenItIsNamed)
{
    std::string text;
    for (int i = 0; i < 100'000; ++i)
        text += "mtllib a.mtl\n";
    std::string materials;
    for (int i = 0; i < 1000; ++i)
        materials += "newmtl m" + std::to_string(i) + "\nKd 1 0 0\n";
    const ImportedMesh result =
        mesh_of(text + "mtllib gone.mtl\nmtllib gone.mtl\n" + kSquare + "f 1 2 3\n", {{"a.mtl", materials}});
    EXPECT_EQ(result.mesh.materials.size(), 1001u); // and the grey of the triangle that names none
    EXPECT_EQ(result.notes.size(), 1u);
}

TEST(ReadObj, StopsAtMoreMaterialsThanCanBeNumbered)
{
    std::string names, materials;
    for (int i = 0; i < 20'000; ++i)
        materials += "newmtl m\n";
    Files files;
    for (char c = 'a'; c <= 'd'; ++c) {
        names += std::string("mtllib ") + c + ".mtl\n";
        files[std::string(1, c) + ".mtl"] = materials;
    }
    auto result = read(names + kSquare + "f 1 2 3\n", files);
    ASSERT_TRUE(std::holds_alternative<ImportFault>(result));
    EXPECT_EQ(std::get<ImportFault>(result).code, "over_limit");
    EXPECT_THAT(std::get<ImportFault>(result).detail, testing::HasSubstr("\"d.mtl\""));
}

TEST(ReadObj, TellsOfBadMaterialLinesNoMoreThanOfOthers)
{
    std::string names, materials = "newmtl m\n";
    for (int i = 0; i < 20; ++i)
        materials += "Kd nothing\n";
    Files files;
    for (char c = 'a'; c <= 'z'; ++c) {
        names += std::string("mtllib ") + c + ".mtl\n";
        files[std::string(1, c) + ".mtl"] = materials;
    }
    EXPECT_EQ(mesh_of(names + kSquare + "f 1 2 3\n", files).notes.size(), 16u);
}

TEST(ReadObj, MakesMaterialsWithoutAReadableColourGreyAndNamesThem)
{
    const Files files{{"a.mtl",
                       "newmtl red\nnewmtl wood\nmap_Kd wood.png\nnewmtl odd\nKd bogus\n"
                       "newmtl black\nKd 0 0 0\n"}};
    const ImportedMesh result =
        mesh_of("mtllib a.mtl\n" + kSquare + "usemtl red\nf 1 2 3\nusemtl gone\nf 1 3 4\n", files);
    const renderer::Rgb grey{0.5f, 0.5f, 0.5f};
    ASSERT_EQ(result.mesh.materials.size(), 5u);
    for (const std::size_t i : {0u, 1u, 2u, 4u})
        EXPECT_EQ(result.mesh.materials[i].diffuse, grey) << result.mesh.materials[i].name;
    EXPECT_EQ(result.mesh.materials[3].diffuse, (renderer::Rgb{0, 0, 0})); // said, so kept
    EXPECT_THAT(result.notes,
                testing::ElementsAre(testing::HasSubstr("wood.png did not come"),
                                     testing::HasSubstr("line 5"),
                                     "material file \"a.mtl\": 3 materials have no readable Kd and are grey "
                                     "(0.5): \"red\", \"wood\", \"odd\"",
                                     testing::HasSubstr("\"gone\"")));
}

TEST(ReadObj, ReportsAMaterialWithoutColourWhereverItStandsInItsFile)
{
    const std::string text = "mtllib a.mtl\n" + kSquare + "usemtl red\nf 1 2 3\n";
    EXPECT_THAT(mesh_of(text, {{"a.mtl", "newmtl red"}}).notes,
                testing::ElementsAre(
                    "material file \"a.mtl\": 1 material has no readable Kd and is grey (0.5): \"red\""));
    std::string many = "newmtl blue\nKd 0 0 1\n";
    for (int i = 0; i < 100; ++i)
        many += "newmtl m" + std::to_string(i) + "\n";
    const ImportedMesh result = mesh_of(text, {{"a.mtl", many + "newmtl red\nKd 1 0 0\n"}});
    EXPECT_THAT(result.notes, testing::ElementsAre(testing::HasSubstr("100 materials")));
    EXPECT_LT(result.notes[0].size(), 200u);
}

TEST(ReadObj, TakesMaterialsWhoseModelIsGlassAsGlass)
{
    const Files files{{"a.mtl",
                       "newmtl water\nKd 1 1 1\nillum 7\nNi 1.33\nd 0.1\n"
                       "newmtl dense\nKd 1 1 1\nillum 4\nNi 99\nTf 0.5 1 0.25\n"
                       "newmtl matt\nKd 1 1 1\nillum 2\nNi 1.5\nd 0.1\n"}};
    const std::string body = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    const ImportedMesh result = mesh_of("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl water\n" +
                                            body + "usemtl dense\n" + body + "usemtl matt\n" + body,
                                        files);
    const auto& materials = result.mesh.materials;
    ASSERT_GE(materials.size(), 3u);
    EXPECT_TRUE(materials[0].is_glass);
    EXPECT_FALSE(materials[0].is_transparent) << "nothing of it is left out";
    EXPECT_FLOAT_EQ(materials[0].ior, 1.33f);
    EXPECT_TRUE(materials[1].is_glass);
    EXPECT_FLOAT_EQ(materials[1].ior, 10);
    EXPECT_EQ(materials[0].transmission, (renderer::Rgb{1, 1, 1}));
    EXPECT_EQ(materials[1].transmission, (renderer::Rgb{0.5f, 1, 0.25f}));
    EXPECT_FALSE(materials[2].is_glass);
    EXPECT_TRUE(materials[2].is_transparent);
}

TEST(ReadObj, KeepsWhatItsMaterialsHaveThatIsNotModelled)
{
    const Files files{{"a.mtl",
                       "newmtl plain\nKd 1 1 1\nKe 0 0 0\nd 1\nTr 0\nPm 0\n"
                       "newmtl lamp\nKd 1 1 1\nKe 8 8 7\n"
                       "newmtl glass\nKd 1 1 1\nd -halo 0.3\n"
                       "newmtl water\nKd 1 1 1\nTr 0.7\n"
                       "newmtl gold\nKd 1 1 1\nPm 0.9\nPr 0.2\n"}};
    const auto materials = mesh_of("mtllib a.mtl\n" + kSquare + "f 1 2 3\n", files).mesh.materials;
    ASSERT_GE(materials.size(), 5u);
    const auto traits = [&](std::size_t i) {
        const renderer::MeshMaterial& m = materials[i];
        return std::string(m.emits ? "e" : "") + (m.is_transparent ? "t" : "") + (m.is_metal ? "m" : "") +
               (m.has_roughness ? "r" : "");
    };
    EXPECT_EQ(traits(0), "");
    EXPECT_EQ(traits(1), "") << "it shines";
    EXPECT_EQ(traits(2), "t");
    EXPECT_EQ(traits(3), "t");
    EXPECT_EQ(traits(4), "mr");
}

TEST(ReadObj, TakesEmissionOfAnyStrengthButNotByAPicture)
{
    const Files files{{"a.mtl",
                       "newmtl dark\nKd 1 1 1\nKe 0 0 0\n"
                       "newmtl lamp\nKd 1 1 1\nKe 8 8.5 -7\n"
                       "newmtl windows\nKd 1 1 1\nKe 1 1 1\nmap_Ke lit.png\n"
                       "newmtl last\nmap_Ke lit.png\nKe 2\n"}};
    const auto materials = mesh_of("mtllib a.mtl\n" + kSquare + "f 1 2 3\n", files).mesh.materials;
    ASSERT_GE(materials.size(), 4u); // and one of faces without a name
    EXPECT_EQ(materials[0].emission, renderer::Rgb{});
    EXPECT_EQ(materials[1].emission, (renderer::Rgb{8, 8.5f, 0}));
    for (const std::size_t by_picture : {std::size_t{2}, std::size_t{3}}) {
        EXPECT_EQ(materials[by_picture].emission, renderer::Rgb{}) << by_picture;
        EXPECT_TRUE(materials[by_picture].emits) << by_picture;
    }
    EXPECT_FALSE(materials[0].emits || materials[1].emits);
}

TEST(ReadObj, SaysThatMapsOfHeightsAreLeftOut)
{
    const std::string text = "mtllib a.mtl\n" + kSquare + "usemtl a\nf 1 2 3\n";
    const auto notes = [&](const std::string& mtl) { return mesh_of(text, {{"a.mtl", mtl}}).notes; };
    EXPECT_THAT(notes("newmtl a\nKd 1 1 1\nmap_Bump -bm 0.2 h.png\nbump h.png\nnewmtl b\nKd 1 1 1\n"),
                testing::ElementsAre(testing::HasSubstr("\"a.mtl\": 1 material has a bump map, heights")));
    EXPECT_THAT(notes("newmtl a\nKd 1 1 1\nbump h.png\nnewmtl b\nKd 1 1 1\nmap_bump h.png\n"),
                testing::ElementsAre(testing::HasSubstr("2 materials have bump maps")));
    EXPECT_THAT(notes("newmtl a\nKd 1 1 1\n"), testing::IsEmpty());
}

TEST(ReadObj, SaysWhenItsMtlIsMissing)
{
    const ImportedMesh result = mesh_of("mtllib gone.mtl\nusemtl red\n" + kSquare + "f 1 2 3\n");
    EXPECT_TRUE(result.mesh.materials.empty());
    EXPECT_TRUE(result.mesh.triangle_materials.empty());
    EXPECT_THAT(result.notes,
                testing::ElementsAre(testing::HasSubstr("\"gone.mtl\" did not come with the mesh")));
}

TEST(ReadObj, MakesEveryObjectOneRunOfTriangles)
{
    const Mesh mesh =
        mesh_of(kSquare + "o a\nf 1 2 3\no b\nf 2 3 4\ng ignored\nf 3 4 1\no a\nf 4 1 2\n").mesh;
    ASSERT_EQ(mesh.parts.size(), 2u);
    EXPECT_EQ(mesh.parts[0].name, "a");
    EXPECT_EQ(mesh.parts[0].first_triangle, 0u);
    EXPECT_EQ(mesh.parts[0].triangle_count, 2u);
    EXPECT_EQ(mesh.parts[1].name, "b");
    EXPECT_EQ(mesh.parts[1].first_triangle, 2u);
    EXPECT_EQ(mesh.parts[1].triangle_count, 2u);
}

TEST(ReadObj, TakesGroupsAsPartsWhereThereAreNoObjects)
{
    const Mesh mesh = mesh_of(kSquare + "f 1 2 3\ng left arm\nf 2 3 4\n").mesh;
    ASSERT_EQ(mesh.parts.size(), 1u);
    EXPECT_EQ(mesh.parts[0].name, "left arm");
    EXPECT_EQ(mesh.parts[0].first_triangle, 1u);
}

TEST(ReadObj, JoinsLinesThatEndInABackslashAndReadsDosLineEnds)
{
    EXPECT_EQ(mesh_of("v 0 0 0\r\nv 1 0 0\r\nv 1 1 \\\r\n0\r\nf 1 \\\r\n2 3\r\n").mesh.triangles.size(), 1u);
}

TEST(ReadObj, NamesTheLineOfWhatIsWrong)
{
    EXPECT_EQ(fault_of(kSquare + "f 1 2 9\n").code, "index_out_of_range");
    EXPECT_THAT(fault_of(kSquare + "f 1 2 9\n").detail, testing::HasSubstr("line 5"));
    EXPECT_THAT(fault_of(kSquare + "f 1 2 -9\n").detail, testing::HasSubstr("line 5"));
    EXPECT_EQ(fault_of(kSquare + "f 1 2 0\n").code, "index_out_of_range");
    EXPECT_EQ(fault_of(kSquare + "f 1 2 x\n").code, "malformed");
    EXPECT_EQ(fault_of(kSquare + "f 1/1/1/1 2 3\n").code, "malformed");
    EXPECT_EQ(fault_of("v 0 nan 0\n").code, "non_finite");
    EXPECT_THAT(fault_of("v 0 0 0\nv 0 nan 0\n").detail, testing::HasSubstr("vertex 2"));
    EXPECT_EQ(fault_of("v 0 1e39 0\n").code, "non_finite");
    EXPECT_EQ(fault_of("v 0 0\nv 0 0 0\n").code, "malformed");
    EXPECT_THAT(fault_of("v 0x1p3 0 0\nv 0 0 0\n").detail, testing::HasSubstr("0x1p3 0 0"));
    EXPECT_EQ(fault_of(kSquare + "v 0 0").code, "truncated");
    EXPECT_EQ(fault_of(kSquare + "f 1 2").code, "truncated");
}

TEST(ReadObj, ReadsNumbersTooSmallForAFloatAsZero)
{
    const Mesh mesh = mesh_of("v 1e-60 -1e-400 1e-40\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").mesh;
    EXPECT_EQ(mesh.positions[0].x, 0);
    EXPECT_EQ(mesh.positions[0].y, 0);
    EXPECT_GT(mesh.positions[0].z, 0); // subnormal, but there
}

TEST(ReadObj, ReadsPlainTrianglesAsItReadsAnyOthers)
{
    const std::string many = "vt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 1 0\n";
    for (const char* corners :
         {"1 2 3", "1/1 2/2 3/1", "1//1 2//2 3//1", "1/1/1 2/2/2 3/1/2", "1/ 2/ 3/", "1 2/1 3//2"}) {
        const Mesh quick = mesh_of(kSquare + many + "f " + corners + "\n").mesh;
        const Mesh slow = mesh_of(kSquare + many + "f " + corners + " # so\n").mesh;
        EXPECT_EQ(quick.triangles, slow.triangles) << corners;
        EXPECT_EQ(quick.positions, slow.positions) << corners;
        EXPECT_EQ(quick.normals, slow.normals) << corners;
        EXPECT_EQ(quick.uvs, slow.uvs) << corners;
    }
    for (const char* corners :
         {"1 2 0", "1/ /2 3", "1 2 3/", "1 2 3//", "1/1/1/1 2 3", "1 2 4294967297", "1 2 x"}) {
        const auto quick = read(kSquare + "f " + corners + "\n"),
                   slow = read(kSquare + "f " + corners + " # so\n");
        ASSERT_EQ(quick.index(), slow.index()) << corners;
        if (const auto* fault = std::get_if<ImportFault>(&quick)) {
            EXPECT_EQ(fault->detail, std::get<ImportFault>(slow).detail) << corners;
        }
    }
}

TEST(ReadObj, CountsTheTrianglesOfALargeFileBeforeItReadsIt)
{
    renderer::Limits limits;
    limits.triangles = 2;
    const auto result =
        read(kSquare + "f 1 2 3 4\nf 1 2 3 # 4 5 6\nf 1 2\nf 1 \\\n 2 3\nv nan 0 0\n", {}, limits);
    ASSERT_TRUE(std::holds_alternative<ImportFault>(result));
    EXPECT_EQ(std::get<ImportFault>(result).detail, "4 triangles, the limit is 2 (--limit-triangles)");
}

} // namespace
