// The program heliograph as a user runs it, without a service; with one: tests/end_to_end.
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::bytes_of;
using tests::ProgramRun;
using tests::TempFolder;

const std::string kAssets = tests::asset_dir();

ProgramRun heliograph(std::vector<std::string> words,
                      const std::string& input = {},
                      std::vector<std::string> environment = {})
{
    words.insert(words.begin(), tests::bin_dir() + "/heliograph");
    environment.emplace_back("HELIOGRAPH_URL=http://127.0.0.1:9"); // the discard port: nobody answers
    return tests::run_program(words, input, environment);
}

// Knot, shape, light and material; small enough to render many times.
std::string knot_scene(const std::string& more = "")
{
    return R"({"scene":{
        "materials":{"clay":{"type":"phong","diffuse":[0.6,0.4,0.3],"specular":[0.2,0.2,0.2]}},
        "objects":[{"mesh":"knot.obj","material":"clay"},
                   {"shape":"rectangle","size":[6,6],"transform":[{"rotate_deg":-90,"axis":[1,0,0]},{"translate":[0,-1.1,0]}]}],
        "lights":[{"type":"point","position":[2,3,4],"intensity":[40,40,40]}]},
        "image":{"width":70,"height":45},"quality":{"samples":3})" +
           more + "}";
}

void copy_asset(const TempFolder& folder, const std::string& name)
{
    std::filesystem::copy_file(kAssets + '/' + name, folder.file(name));
}

TEST(Heliograph, TellsItsVersionAndItsExitCodes)
{
    const ProgramRun version = heliograph({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, StartsWith("heliograph 0."));
    EXPECT_THAT(version.out, HasSubstr("commit"));
    EXPECT_THAT(version.out, HasSubstr("compiler"));
    const ProgramRun help = heliograph({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Exit status:"));
    EXPECT_THAT(help.out, HasSubstr("130"));
    EXPECT_THAT(heliograph({"submit", "--help"}).out, HasSubstr("HELIOGRAPH_URL"));
}

TEST(Heliograph, TellsWhatTheImportMissedOnStandardErrorAndInTheReport)
{
    const TempFolder folder;
    folder.write("a.obj", "mtllib gone.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string scene = folder.write(
        "scene.json",
        R"({"scene":{"objects":[{"mesh":"a.obj"}]},"image":{"width":8,"height":8},"quality":{"samples":1}})");
    const ProgramRun run =
        heliograph({"render", scene, "-o", folder.file("out.png"), "--report", folder.file("report.json")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string note = "a.obj: material file \"gone.mtl\" did not come with the mesh";
    EXPECT_THAT(run.err, HasSubstr("note: " + note));
    const auto notes = nlohmann::json::parse(bytes_of(folder.file("report.json"))).at("notes");
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_THAT(notes[0].get<std::string>(), StartsWith(note));
}

TEST(Heliograph, WritesTheLayersThatItIsAskedFor)
{
    const TempFolder folder;
    copy_asset(folder, "knot.obj");
    const std::string scene = folder.write("scene.json", knot_scene());
    const ProgramRun run = heliograph({"render",
                                       scene,
                                       "-o",
                                       folder.file("out.exr"),
                                       "--layer",
                                       "depth=" + folder.file("depth.pfm"),
                                       "--layer",
                                       "normal=" + folder.file("normal.png")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(bytes_of(folder.file("depth.pfm")), StartsWith("Pf\n70 45\n-1.0\n"));
    EXPECT_THAT(bytes_of(folder.file("normal.png")), StartsWith("\x89PNG"));
    // The picture's own file has them, and is the same picture.
    EXPECT_THAT(bytes_of(folder.file("out.exr")), HasSubstr("N.X"));
    EXPECT_EQ(heliograph({"render", scene, "-o", folder.file("plain.exr")}).exit_code, 0);
    EXPECT_THAT(heliograph({"compare", folder.file("out.exr"), folder.file("plain.exr"), "--json"}).out,
                HasSubstr("\"rmse\":0"));
}

TEST(Heliograph, RefusesLayersThatItCannotWriteBeforeItRenders)
{
    const TempFolder folder;
    copy_asset(folder, "knot.obj");
    const std::string scene = folder.write("scene.json", knot_scene());
    for (const std::string layer :
         {"depth", "=a.exr", "depht=a.exr", "depth=a.png", "normal=a.jpg", "albedo=/no/such/folder/a.exr"}) {
        const ProgramRun run = heliograph({"render", scene, "-o", folder.file("out.png"), "--layer", layer});
        EXPECT_EQ(run.exit_code, 2) << layer << run.err;
        EXPECT_FALSE(std::filesystem::exists(folder.file("out.png"))) << layer;
    }
}

TEST(Heliograph, LetsTimeAsAFlagWinOverSamplesOfTheEnvironment)
{
    const TempFolder folder;
    const std::string scene = folder.write(
        "scene.json", R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":8,"height":8}})");
    const std::string report = folder.file("report.json");
    const std::vector<std::string> words{
        "render", scene, "-q", "-o", folder.file("out.png"), "--report", report};
    const auto with = [&words](const std::vector<std::string>& more) {
        std::vector<std::string> all = words;
        all.insert(all.end(), more.begin(), more.end());
        return heliograph(all, {}, {"HELIOGRAPH_SAMPLES=3"});
    };
    EXPECT_EQ(with({}).exit_code, 0);
    EXPECT_EQ(nlohmann::json::parse(bytes_of(report)).at("accuracy").at("samples"), 3);
    const ProgramRun timed = with({"--time", "0.05"});
    EXPECT_EQ(timed.exit_code, 0) << timed.err;
    EXPECT_EQ(nlohmann::json::parse(bytes_of(report)).at("accuracy").at("requested").at("time_s"), 0.05);
    EXPECT_EQ(with({"--samples", "2", "--time", "1"}).exit_code, 2) << "two flags";
    EXPECT_EQ(with({"--time", "1", "--samples", "2"}).exit_code, 2) << "two flags";
}

TEST(Heliograph, RefusesWrongUseWith2)
{
    const TempFolder folder;
    const std::string scene = folder.write("scene.json", knot_scene());
    EXPECT_EQ(heliograph({}).exit_code, 2);
    EXPECT_EQ(heliograph({"rendr"}).exit_code, 2);
    EXPECT_EQ(heliograph({"render", scene}).exit_code, 2) << "no --output";
    EXPECT_EQ(heliograph({"render", scene, "-o", folder.file("a.gif")}).exit_code, 2);
    EXPECT_EQ(heliograph({"render", scene, "-o", folder.file("absent/a.png")}).exit_code, 2);
    EXPECT_EQ(heliograph({"render", scene, "-o", folder.file("a.png"), "--samples", "none"}).exit_code, 2);
    EXPECT_EQ(
        heliograph({"render", scene, "-o", folder.file("a.png"), "--samples", "4", "--time", "1"}).exit_code,
        2);
    EXPECT_EQ(heliograph({"render", folder.file("absent.json"), "-o", folder.file("a.png")}).exit_code, 2);
    EXPECT_EQ(heliograph({"status", "../x"}).exit_code, 2);
    EXPECT_EQ(heliograph({"list", "--url", "gopher://x"}).exit_code, 2);
    EXPECT_EQ(heliograph({"list", "--state", "bogus"}).exit_code, 2);
}

TEST(Heliograph, SaysThatNoServiceAnswersWith4)
{
    const ProgramRun run = heliograph({"status", "abc"});
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_THAT(run.err, HasSubstr("HELIOGRAPH_URL"));
    EXPECT_EQ(heliograph({"list"}).exit_code, 4);
    EXPECT_EQ(heliograph({"health"}).exit_code, 1);
}

TEST(HeliographCheck, TellsEveryFaultWithItsPointerAnd3)
{
    const TempFolder folder;
    const std::string scene = folder.write(
        "scene.json",
        R"({"scene":{"camera":{"fov_deg":200},"objects":[{"shape":"sphere","radius":-1,"colour":1}]},"imag":{}})");
    const ProgramRun run = heliograph({"check", scene});
    EXPECT_EQ(run.exit_code, 3);
    for (const char* pointer :
         {"/scene/camera/fov_deg", "/scene/objects/0/radius", "/scene/objects/0/colour", "/imag"})
        EXPECT_THAT(run.err, HasSubstr(pointer));
    EXPECT_EQ(heliograph({"check", "-"}, "{").exit_code, 3);
    EXPECT_EQ(heliograph({"check", "-"}, "").exit_code, 3);
}

TEST(HeliographCheck, LooksIntoTheMeshes)
{
    const TempFolder folder;
    const std::string absent = R"({"scene":{"objects":[{"shape":"box"},{"mesh":"absent.obj"}]}})";
    ProgramRun run = heliograph({"check", folder.write("scene.json", absent)});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.err, HasSubstr("/scene/objects/1/mesh"));
    run = heliograph({"check", kAssets + "/broken/nan.ply"});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.err, HasSubstr("non_finite"));
    run = heliograph({"check", "-"},
                     R"({"scene":{"objects":[{"mesh":"sha256:)" + std::string(64, 'a') + R"("}]}})");
    EXPECT_EQ(run.exit_code, 3) << "a digest is no file";
    EXPECT_THAT(run.err, HasSubstr("/scene/objects/0/mesh"));
}

TEST(HeliographCheck, ExpandsToAJobThatExpandsToItself)
{
    const TempFolder folder;
    copy_asset(folder, "knot.ply");
    const std::string scene = folder.write("scene.json", R"({"scene":{"objects":[{"mesh":"knot.ply"}]}})");
    const ProgramRun once = heliograph({"check", scene, "--expand"});
    ASSERT_EQ(once.exit_code, 0) << once.err;
    for (const char* assumed : {"\"camera\"", "\"look_at\"", "\"environment\"", "\"lights\"", "\"seed\""})
        EXPECT_THAT(once.out, HasSubstr(assumed));
    const ProgramRun twice = heliograph({"check", folder.write("expanded.json", once.out), "--expand"});
    ASSERT_EQ(twice.exit_code, 0) << twice.err;
    EXPECT_EQ(twice.out, once.out);
}

TEST(HeliographRender, GivesTheSameBytesWhateverTheThreadsAndTiles)
{
    const TempFolder folder;
    copy_asset(folder, "knot.obj");
    const std::string scene = folder.write("scene.json", knot_scene());
    ASSERT_EQ(heliograph({"render", scene, "-o", folder.file("first.png")}).exit_code, 0);
    ASSERT_EQ(heliograph({"render", scene, "-o", folder.file("first.pfm")}).exit_code, 0);
    const std::string png = bytes_of(folder.file("first.png")), pfm = bytes_of(folder.file("first.pfm"));
    EXPECT_THAT(png, StartsWith("\x89PNG"));
    EXPECT_THAT(pfm, StartsWith("PF\n70 45\n"));
    for (const char* threads : {"1", "2", "8"}) {
        for (const char* tile : {"1", "16", "64"}) {
            const std::vector<std::string> words{"render", scene, "--threads", threads, "--tile", tile, "-o"};
            std::vector<std::string> to_png = words, to_pfm = words;
            to_png.push_back(folder.file("again.png"));
            to_pfm.push_back(folder.file("again.pfm"));
            ASSERT_EQ(heliograph(to_png).exit_code, 0);
            ASSERT_EQ(heliograph(to_pfm).exit_code, 0);
            EXPECT_TRUE(bytes_of(folder.file("again.png")) == png)
                << threads << " threads, tiles of " << tile;
            EXPECT_TRUE(bytes_of(folder.file("again.pfm")) == pfm)
                << threads << " threads, tiles of " << tile;
        }
    }
}

TEST(HeliographRender, LetsOptionsGoBeforeTheScene)
{
    const TempFolder folder;
    copy_asset(folder, "knot.obj");
    const std::string scene = folder.write("scene.json", knot_scene());
    const std::string as_said = folder.write("said.json", knot_scene(R"(,"seed":7)"));
    const auto render = [&](std::vector<std::string> words, const char* name) {
        words.insert(words.begin(), "render");
        words.insert(words.end(), {"-o", folder.file(name)});
        const ProgramRun run = heliograph(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        return bytes_of(folder.file(name));
    };
    EXPECT_EQ(render({as_said}, "a.pfm"), render({scene, "--seed", "7"}, "b.pfm"));
    EXPECT_NE(render({scene}, "c.pfm"), render({scene, "--seed", "7"}, "d.pfm"));
    EXPECT_NE(render({scene}, "e.pfm"), render({scene, "--samples", "5"}, "f.pfm"));
    EXPECT_THAT(render({scene, "--width", "20", "--height", "10"}, "g.pfm"), StartsWith("PF\n20 10\n"));
    EXPECT_EQ(heliograph({"render", scene, "--width", "0", "-o", folder.file("h.png")}).exit_code, 3);
}

TEST(HeliographRender, WritesAReport)
{
    const TempFolder folder;
    copy_asset(folder, "knot.obj");
    const std::string scene = folder.write("scene.json", knot_scene());
    const ProgramRun run =
        heliograph({"render", scene, "-o", folder.file("a.png"), "--report", folder.file("report.json")});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string report = bytes_of(folder.file("report.json"));
    for (const char* member :
         {"\"accuracy\"", "\"models\"", "\"numerics\"", "\"timing\"", "\"render_key\"", "sha256:"})
        EXPECT_THAT(report, HasSubstr(member));
}

TEST(HeliographRender, TakesAMeshAloneAndASceneFromStandardInput)
{
    const TempFolder folder;
    for (const char* mesh : {"knot.obj", "knot.ply", "knot_ascii.ply", "knot.stl", "knot.glb", "knot.gltf"}) {
        const ProgramRun run = heliograph({"render",
                                           kAssets + '/' + mesh,
                                           "--samples",
                                           "1",
                                           "--width",
                                           "32",
                                           "--height",
                                           "24",
                                           "-o",
                                           folder.file("mesh.png")});
        EXPECT_EQ(run.exit_code, 0) << mesh << ": " << run.err;
        EXPECT_THAT(bytes_of(folder.file("mesh.png")), StartsWith("\x89PNG"));
    }
    const std::string words =
        R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":8,"height":8},"quality":{"samples":1}})";
    const ProgramRun piped = heliograph({"render", "-", "-o", "-"}, words);
    EXPECT_EQ(piped.exit_code, 0) << piped.err;
    EXPECT_THAT(piped.out, StartsWith("\x89PNG"));
    EXPECT_EQ(piped.err, "") << "quiet where stderr is no terminal";
}

TEST(HeliographRender, NeverReadsAboveTheMeshsFolder)
{
    const TempFolder folder;
    folder.write("outside.mtl", "newmtl root\nKd 1 0 0\n");
    folder.write("inside/a.obj", "mtllib ../outside.mtl\nusemtl root\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const ProgramRun run = heliograph({"check", folder.file("inside/a.obj")});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("outside.mtl")) << "the note that it is missing";
}

TEST(HeliographCompare, MeasuresAndRefusesDifferentSizes)
{
    const TempFolder folder;
    const std::string words =
        R"({"scene":{"objects":[{"shape":"sphere"}]},"image":{"width":8,"height":8},"quality":{"samples":1}})";
    ASSERT_EQ(heliograph({"render", "-", "-o", folder.file("a.png")}, words).exit_code, 0);
    ASSERT_EQ(heliograph({"render", "-", "-o", folder.file("a.pfm")}, words).exit_code, 0);
    ASSERT_EQ(heliograph({"render", "-", "-o", folder.file("b.png"), "--width", "9"}, words).exit_code, 0);
    const ProgramRun same = heliograph({"compare", folder.file("a.png"), folder.file("a.png"), "--json"});
    EXPECT_EQ(same.exit_code, 0);
    EXPECT_EQ(same.out,
              "{\"rmse\":0,\"relative_rmse\":0,\"max\":0,\"mean\":[0,0,0],\"non_finite_pixels\":0}\n");
    const ProgramRun across = heliograph({"compare", folder.file("a.png"), folder.file("a.pfm")});
    EXPECT_EQ(across.exit_code, 0) << across.err;
    EXPECT_THAT(across.out, StartsWith("rmse "));
    for (const char* name : {"c.exr", "c.hdr", "c.jpg"}) {
        ASSERT_EQ(heliograph({"render", "-", "-o", folder.file(name)}, words).exit_code, 0) << name;
        const ProgramRun run = heliograph({"compare", folder.file(name), folder.file("a.pfm")});
        EXPECT_EQ(run.exit_code, 0) << run.err;
    }
    const ProgramRun exact = heliograph({"compare", folder.file("c.exr"), folder.file("a.pfm"), "--json"});
    EXPECT_EQ(exact.out, same.out);
    ASSERT_EQ(heliograph({"render", "-", "-o", folder.file("d.png"), "--bits", "16"}, words).exit_code, 0);
    EXPECT_THAT(bytes_of(folder.file("d.png")).substr(16, 9), EndsWith("\x10")) << "bits a channel";
    EXPECT_EQ(heliograph({"render", "-", "-o", folder.file("d.exr"), "--bits", "16"}, words).exit_code, 2);
    EXPECT_EQ(heliograph({"render", "-", "-o", folder.file("d.gif")}, words).exit_code, 2);
    const ProgramRun sizes = heliograph({"compare", folder.file("a.png"), folder.file("b.png")});
    EXPECT_EQ(sizes.exit_code, 2);
    EXPECT_THAT(sizes.err, HasSubstr("8x8"));
    EXPECT_EQ(heliograph({"compare", folder.file("a.png"), folder.file("absent.png")}).exit_code, 2);
}

} // namespace
