// COLLADA, FBX, 3DS and OFF: the same mesh from each, its frame, and the exact fault of every broken one.
#include "renderer/io/import_mesh.h"
#include "renderer/io/node_graph.h"
#include "renderer/io/read_fbx.h"
#include "renderer/io/xml_scan.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace {

using renderer::ImportedMesh;
using renderer::ImportFault;
using renderer::ImportResult;
using renderer::XmlScan;

std::string asset(const std::string& name)
{
    return tests::bytes_of(std::filesystem::path(tests::asset_dir()) / name);
}

ImportResult
read(const std::string& name, const std::string& bytes, std::vector<std::string>* asked = nullptr)
{
    return renderer::import_mesh(name,
                                 std::as_bytes(std::span(bytes)),
                                 [asked](std::string_view file) -> std::optional<std::span<const std::byte>> {
                                     if (asked) asked->emplace_back(file);
                                     return std::nullopt;
                                 },
                                 {});
}

ImportedMesh imported(const std::string& name)
{
    auto result = read(name, asset(name));
    if (const auto* fault = std::get_if<ImportFault>(&result)) {
        ADD_FAILURE() << name << ": " << fault->code << ": " << fault->detail;
        return {};
    }
    return std::move(std::get<ImportedMesh>(result));
}

double area(const renderer::Mesh& mesh)
{
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const auto a = to_double(mesh.positions[t[0]]);
        sum += length(cross(to_double(mesh.positions[t[1]]) - a, to_double(mesh.positions[t[2]]) - a)) / 2;
    }
    return sum;
}

TEST(ReadScenes, GiveTheSameKnotAsObj)
{
    const renderer::Mesh wanted = imported("knot.obj").mesh;
    for (const char* name : {"knot.off", "knot.dae", "knot.fbx", "knot_ascii.fbx", "knot.3ds"}) {
        const ImportedMesh knot = imported(name);
        EXPECT_EQ(knot.mesh.triangles.size(), 6144u) << name;
        EXPECT_NEAR(area(knot.mesh), area(wanted), 1e-4 * area(wanted)) << name;
        if (std::string(name) == "knot.3ds") continue; // whose z was up
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(knot.mesh.bounds().lower[axis], wanted.bounds().lower[axis], 1e-5) << name;
            EXPECT_NEAR(knot.mesh.bounds().upper[axis], wanted.bounds().upper[axis], 1e-5) << name;
        }
    }
    EXPECT_EQ(imported("knot.off").format, "off");
    EXPECT_EQ(imported("knot_ascii.fbx").format, "fbx");
    EXPECT_EQ(imported("knot.3ds").format, "3ds");
    EXPECT_EQ(imported("knot.dae").format, "dae");
}

// The box is 1 x 2 x 4 along the file's axes.
TEST(ReadScenes, TurnUnitsToMetresAndTheUpAxisToY)
{
    struct Case {
        const char* name;
        std::array<double, 3> size;
    };
    for (const Case& c : {Case{"inches_z_up.dae", {0.0254, 4 * 0.0254, 2 * 0.0254}},
                          Case{"x_up.dae", {2, 1, 4}},
                          Case{"inches_z_up.fbx", {0.0254, 4 * 0.0254, 2 * 0.0254}},
                          Case{"x_up_ascii.fbx", {2, 1, 4}},
                          Case{"box.3ds", {1, 4, 2}}}) {
        const renderer::Bounds3f bounds = imported(c.name).mesh.bounds();
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(double(bounds.upper[axis]) - double(bounds.lower[axis]), c.size[axis], 1e-5)
                << c.name << ", axis " << axis;
    }
}

TEST(ReadScenes, KeepTheWindingWhereAxesAreTurned)
{
    for (const char* name : {"inches_z_up.dae", "x_up.dae", "inches_z_up.fbx", "x_up_ascii.fbx", "box.3ds"}) {
        const renderer::Mesh mesh = imported(name).mesh;
        for (const auto& t : mesh.triangles) {
            const auto a = to_double(mesh.positions[t[0]]), b = to_double(mesh.positions[t[1]]),
                       c = to_double(mesh.positions[t[2]]);
            EXPECT_GT(dot(cross(b - a, c - a), a + b + c), 0) << name; // the box lies about the origin
        }
    }
}

TEST(ReadScenes, TakeMaterialsFromCollada)
{
    const renderer::Mesh mesh = imported("knot.dae").mesh;
    ASSERT_FALSE(mesh.materials.empty());
    EXPECT_NEAR(mesh.materials[0].diffuse.r, 0.8f, 1e-6);
    EXPECT_NEAR(mesh.materials[0].diffuse.g, 0.1f, 1e-6);
}

TEST(ReadScenes, GiveEveryBrokenFileItsFault)
{
    std::istringstream manifest(asset("broken/manifest.tsv"));
    int files = 0;
    for (std::string line; std::getline(manifest, line);) {
        std::istringstream fields(line);
        std::string name, codes, what;
        std::getline(std::getline(std::getline(fields, name, '\t'), codes, '\t'), what);
        const std::string extension = std::filesystem::path(name).extension();
        if (extension != ".dae" && extension != ".fbx" && extension != ".3ds" && extension != ".off")
            continue;
        ++files;
        const auto result = read(name, asset("broken/" + name));
        const auto* fault = std::get_if<ImportFault>(&result);
        EXPECT_THAT("," + codes + ",", testing::HasSubstr("," + (fault ? fault->code : "ok") + ","))
            << name << " (" << what << "): " << (fault ? fault->detail : "it was read");
    }
    EXPECT_GT(files, 30);
}

// Cut anywhere, they are refused, or read whole where only what follows the mesh is lost; none crashes.
TEST(ReadScenes, SurviveBeingCutAnywhere)
{
    for (const char* name : {"inches_z_up.dae", "inches_z_up.fbx", "x_up_ascii.fbx", "box.3ds"}) {
        const std::string whole = asset(name);
        for (std::size_t size = 1; size < whole.size(); size += 1 + whole.size() / 97) {
            const auto result = read(name, whole.substr(0, size));
            if (const auto* mesh = std::get_if<ImportedMesh>(&result)) {
                EXPECT_EQ(mesh->mesh.triangles.size(), 12u) << name << " cut to " << size;
            }
        }
    }
}

TEST(ReadScenes, AskForNoFileThatADocumentNames)
{
    std::vector<std::string> asked;
    std::string dae = asset("x_up.dae");
    dae.insert(dae.find("<library_effects>"),
               "<library_images><image id=\"i\"><init_from>file:///etc/passwd</init_from></image>"
               "<image id=\"j\"><init_from>../../../../etc/passwd</init_from></image></library_images>");
    EXPECT_TRUE(std::holds_alternative<ImportedMesh>(read("x.dae", dae, &asked)));
    EXPECT_THAT(asked, testing::IsEmpty());
}

TEST(XmlScan, WalksElementsAttributesAndText)
{
    XmlScan scan("<?xml version=\"1.0\"?><!-- a --><x:a b=\"1\" c='2'>t<d/><![CDATA[<e>]]></x:a>\n");
    EXPECT_EQ(scan.next(), XmlScan::Event::open);
    EXPECT_EQ(scan.name(), "a");
    EXPECT_EQ(scan.attribute("b"), "1");
    EXPECT_EQ(scan.attribute("c"), "2");
    EXPECT_FALSE(scan.attribute("d"));
    EXPECT_EQ(scan.next(), XmlScan::Event::text);
    EXPECT_EQ(scan.text(), "t");
    EXPECT_EQ(scan.next(), XmlScan::Event::open);
    EXPECT_EQ(scan.next(), XmlScan::Event::close);
    EXPECT_EQ(scan.name(), "d");
    EXPECT_EQ(scan.next(), XmlScan::Event::text);
    EXPECT_EQ(scan.text(), "<e>");
    EXPECT_EQ(scan.next(), XmlScan::Event::close);
    EXPECT_EQ(scan.next(), XmlScan::Event::end);
}

TEST(XmlScan, RefusesWhatIsNotWellFormed)
{
    std::string deep;
    for (int i = 0; i < 600; ++i)
        deep += "<a>";
    for (const std::string& text : {std::string("<a>"),
                                    std::string("<a"),
                                    std::string("<a b"),
                                    std::string("<a b=\"1"),
                                    std::string("<a></b>"),
                                    std::string("</a>"),
                                    std::string("<a/><b/>"),
                                    std::string("x<a/>"),
                                    std::string("<a b=1/>"),
                                    std::string("<a b=\"1\" b=\"2\"/>"),
                                    std::string("<!DOCTYPE a><a/>"),
                                    std::string("<a><!-- </a>"),
                                    std::string(""),
                                    deep}) {
        XmlScan scan(text);
        XmlScan::Event last = scan.next();
        for (int i = 0; i < 2000 && last != XmlScan::Event::fault && last != XmlScan::Event::end; ++i)
            last = scan.next();
        EXPECT_EQ(last, XmlScan::Event::fault) << text.substr(0, 40);
        EXPECT_EQ(scan.next(), XmlScan::Event::end);
    }
}

TEST(NodeGraph, FindsCirclesAndDoublings)
{
    renderer::NodeGraph chain;
    for (std::size_t i = 0; i < 300; ++i)
        chain.add_node();
    for (std::size_t i = 0; i + 1 < 255; ++i)
        chain.add_child(i, i + 1);
    EXPECT_FALSE(chain.check("x"));
    renderer::NodeGraph circle = chain;
    circle.add_child(254, 0);
    EXPECT_EQ(circle.check("x").value().code, "malformed");
    for (std::size_t i = 254; i + 1 < 300; ++i)
        chain.add_child(i, i + 1);
    EXPECT_EQ(chain.check("x").value().code, "over_limit");
    renderer::NodeGraph doubling;
    doubling.add_node();
    for (std::size_t i = 0; i < 30; ++i) {
        doubling.add_node();
        doubling.add_child(i, i + 1);
        doubling.add_child(i, i + 1);
    }
    EXPECT_EQ(doubling.check("x").value().code, "over_limit");
}

} // namespace
