#include "renderer/io/read_ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace {

using renderer::ImportedMesh;
using renderer::ImportFault;
using Triangles = std::vector<renderer::Triangle>;

ImportedMesh mesh_of(const std::string& bytes)
{
    auto result = renderer::read_ply(bytes, {});
    if (const auto* fault = std::get_if<ImportFault>(&result))
        ADD_FAILURE() << fault->code << ": " << fault->detail;
    return std::holds_alternative<ImportedMesh>(result) ? std::get<ImportedMesh>(std::move(result))
                                                        : ImportedMesh();
}

ImportFault fault_of(const std::string& bytes)
{
    auto result = renderer::read_ply(bytes, {});
    return std::holds_alternative<ImportFault>(result) ? std::get<ImportFault>(std::move(result))
                                                       : ImportFault{"none", ""};
}

template <typename T>
std::string big_endian(T value)
{
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (std::endian::native == std::endian::little) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

const std::string kVertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string strips(const std::string& list)
{
    return "ply\nformat ascii 1.0\n" + kVertices +
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + kSquare + list;
}

TEST(ReadPly, AlternatesTheWindingOfAStripAndRestartsAtMinusOne)
{
    EXPECT_EQ(mesh_of(strips("4 0 1 3 2\n")).mesh.triangles, (Triangles{{0, 1, 3}, {3, 1, 2}}));
    EXPECT_EQ(mesh_of(strips("9 0 1 3 2 -1 0 1 2 -1\n")).mesh.triangles,
              (Triangles{{0, 1, 3}, {3, 1, 2}, {0, 1, 2}}));
}

TEST(ReadPly, TakesNoTrianglesFromTheVerticesThatJoinStrips)
{
    // 3 3 2 2: four triangles without area lead from one strip to the next and keep its winding.
    EXPECT_EQ(mesh_of(strips("7 0 1 3 3 3 1 2\n")).mesh.triangles, (Triangles{{0, 1, 3}, {3, 1, 2}}));
}

TEST(ReadPly, RefusesStripsThatNameVerticesThatAreNotThere)
{
    EXPECT_EQ(fault_of(strips("3 0 1 4\n")).code, "index_out_of_range");
    EXPECT_EQ(fault_of(strips("3 0 1 -2\n")).code, "index_out_of_range");
}

TEST(ReadPly, ReadsBigEndianFilesWithEveryKindOfProperty)
{
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\ncomment made here\nelement junk 2\nproperty list uchar double "
        "heights\n"
        "property short s\nelement vertex 3\nproperty double x\nproperty float y\nproperty int16 z\nproperty "
        "uchar red\n"
        "element face 1\nproperty uchar flags\nproperty list uint ushort vertex_index\nend_header\n";
    for (int i = 0; i < 2; ++i)
        bytes += std::string("\x01") + big_endian(2.5) + big_endian<std::int16_t>(7);
    for (std::int16_t i = 0; i < 3; ++i)
        bytes +=
            big_endian(double(i == 1)) + big_endian(float(i == 2)) + big_endian<std::int16_t>(-300) + "\xff";
    bytes += '\x01' + big_endian<std::uint32_t>(3);
    for (std::uint16_t i = 0; i < 3; ++i)
        bytes += big_endian(i);
    const ImportedMesh result = mesh_of(bytes);
    EXPECT_EQ(result.mesh.positions,
              (std::vector<renderer::Vec3f>{{0, 0, -300}, {1, 0, -300}, {0, 1, -300}}));
    EXPECT_EQ(result.mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_TRUE(result.notes.empty());
    for (std::size_t size = 0; size < bytes.size(); ++size)
        ASSERT_EQ(fault_of(bytes.substr(0, size)).code, "truncated") << "cut to " << size;
}

TEST(ReadPly, TakesNormalsAndTextureCoordinatesUnderTheirUsualNames)
{
    const ImportedMesh result =
        mesh_of("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                "z\nproperty float nx\n"
                "property float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 1\n"
                "property list uchar int vertex_indices\nend_header\n0 0 0 0 0 2 0.25 0.5\n1 0 0 0 0 1 1 "
                "1\n0 1 0 0 0 1 0 0\n3 0 1 2");
    ASSERT_EQ(result.mesh.normals.size(), 3u);
    EXPECT_EQ(result.mesh.normals[0], (renderer::Vec3f{0, 0, 1}));
    ASSERT_EQ(result.mesh.uvs.size(), 3u);
    EXPECT_EQ(result.mesh.uvs[0], (renderer::Vec2f{0.25f, 0.5f}));
}

TEST(ReadPly, RefusesHeadersThatLie)
{
    const auto head = [](const std::string& vertices, const std::string& faces) {
        return "ply\nformat ascii 1.0\nelement vertex " + vertices +
               "\nproperty float x\nproperty float y\nproperty float z\n" + "element face " + faces +
               "\nproperty list uchar int vertex_indices\nend_header\n" + kSquare + "3 0 1 2\n";
    };
    EXPECT_EQ(fault_of(head("4", "1")).code, "none");
    EXPECT_EQ(fault_of(head("4", "2")).code, "truncated");
    EXPECT_EQ(fault_of(head("5", "1")).code, "truncated");
    EXPECT_EQ(fault_of(head("18446744073709551615", "1")).code, "malformed"); // beyond what is counted here
    EXPECT_EQ(fault_of(head("9223372036854775807", "1")).code, "truncated");
    EXPECT_EQ(fault_of(head("-1", "1")).code, "malformed");
    EXPECT_EQ(fault_of(head("x", "1")).code, "malformed");
    EXPECT_EQ(fault_of("ply\nend_header\n").code, "malformed");
    EXPECT_EQ(fault_of("ply\nformat ascii 2.0\nend_header\n").code, "malformed");
    EXPECT_EQ(fault_of("ply\nformat ascii 1.0\nend_header\n").code, "malformed");
}

TEST(ReadPly, NamesTheLineOfAWordThatIsNoNumber)
{
    const ImportFault fault =
        fault_of("ply\nformat ascii 1.0\n" + kVertices + "end_header\n0 0 0\n1 x 0\n0 0 0\n0 0 0\n");
    EXPECT_EQ(fault.code, "malformed");
    EXPECT_THAT(fault.detail, testing::HasSubstr("line 9"));
}

// A binary file of three vertices, of the named floats, and one triangle.
std::string floats(const std::string& names, const std::vector<float>& values, const std::string& face)
{
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n";
    for (const char name : names)
        bytes += std::string("property float ") + name + "\n";
    bytes += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    return bytes + face;
}

TEST(ReadPly, ReadsPositionsWhereverTheyStandAmongOtherNumbers)
{
    const std::string face("\x03\0\0\0\0\x01\0\0\0\x02\0\0\0", 13);
    const renderer::Array<renderer::Vec3f> wanted{{0, 1, 2}, {3, 4, 5}, {6, 7, 9}};
    EXPECT_EQ(mesh_of(floats("xyz", {0, 1, 2, 3, 4, 5, 6, 7, 9}, face)).mesh.positions, wanted);
    EXPECT_EQ(mesh_of(floats("axyzb", {9, 0, 1, 2, 9, 9, 3, 4, 5, 9, 9, 6, 7, 9, 9}, face)).mesh.positions,
              wanted);
    EXPECT_EQ(mesh_of(floats("zyx", {2, 1, 0, 5, 4, 3, 9, 7, 6}, face)).mesh.positions, wanted);
    EXPECT_EQ(mesh_of(floats("xayz", {0, 9, 1, 2, 3, 9, 4, 5, 6, 9, 7, 9}, face)).mesh.positions, wanted);
    // Of two of a name the last counts.
    EXPECT_EQ(mesh_of(floats("xyzx", {8, 1, 2, 0, 8, 4, 5, 3, 8, 7, 9, 6}, face)).mesh.positions, wanted);
}

TEST(ReadPly, TellsWhichNumberIsNotFiniteAndWhichVertexIsNotThere)
{
    const std::string face("\x03\0\0\0\0\x01\0\0\0\x02\0\0\0", 13);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const ImportFault bad = fault_of(floats("xyz", {0, 0, 0, 1, nan, 0, 0, 1, 0}, face));
    EXPECT_EQ(bad.code, "non_finite");
    EXPECT_THAT(bad.detail, testing::HasSubstr("vertex 1, before byte 189: y is not finite"));
    std::string far = face;
    far[9] = 3;
    EXPECT_EQ(fault_of(floats("xyz", {0, 0, 0, 1, 0, 0, 0, 1, 0}, far)).code, "index_out_of_range");
    far[12] = '\x80';
    EXPECT_EQ(fault_of(floats("xyz", {0, 0, 0, 1, 0, 0, 0, 1, 0}, far)).code, "index_out_of_range");
}

TEST(ReadPly, RefusesTooManyFacesBeforeItTakesAVertex)
{
    renderer::Limits limits;
    limits.triangles = 1;
    const std::string two = "ply\nformat ascii 1.0\n" + kVertices +
                            "element face 2\nproperty list uchar int vertex_indices\nend_header\n" +
                            "nothing that a number could be, but long enough for what the header says ";
    const auto result = renderer::read_ply(two, limits);
    ASSERT_TRUE(std::holds_alternative<ImportFault>(result));
    EXPECT_EQ(std::get<ImportFault>(result).detail, "2 triangles, the limit is 1 (--limit-triangles)");
    limits = {};
    limits.import_output_bytes = 71;
    const auto large = renderer::read_ply(two, limits);
    ASSERT_TRUE(std::holds_alternative<ImportFault>(large));
    EXPECT_THAT(std::get<ImportFault>(large).detail, testing::HasSubstr("take at least 72 bytes"));
}

} // namespace
