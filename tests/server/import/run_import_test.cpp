#include "server/import/run_import.h"
#include "tests/support/places.h"
#include "tests/support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;
using server::FileDescriptor;
using server::ImportedAsset;
using server::ImportFailure;

const fs::path kImporter = fs::path(tests::bin_dir()) / "heliograph-import";
const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class RunImport : public testing::Test {
protected:
    FileDescriptor file(const std::string& bytes)
    {
        return FileDescriptor(::open(folder_.write("file", bytes).c_str(), O_RDONLY | O_CLOEXEC));
    }

    server::ImportRunEnd
    run(const std::string& bytes, const std::string& extension = "", std::stop_token stop = {})
    {
        const FileDescriptor main = file(bytes);
        const auto open = [this](std::string_view name) {
            asked_.emplace_back(name);
            const auto companion = companions_.find(std::string(name));
            if (companion == companions_.end()) return FileDescriptor();
            return FileDescriptor(
                ::open(folder_.write("companion", companion->second).c_str(), O_RDONLY | O_CLOEXEC));
        };
        return server::run_import({program_, main.get(), extension, false, open, limits_, bytes_}, stop);
    }

    std::string code(const server::ImportRunEnd& end) const
    {
        if (!end.outcome) return "stopped";
        const auto* failure = std::get_if<ImportFailure>(&*end.outcome);
        return failure ? failure->code : "ok";
    }

    // Instead of the importer: a script, to misbehave in ways that the importer has no switch for.
    void misbehave(const std::string& script)
    {
        program_ = folder_.write("importer", "#!/bin/sh\n" + script + "\n");
        fs::permissions(program_, fs::perms::owner_all);
    }

    tests::TempFolder folder_;
    fs::path program_ = kImporter;
    renderer::Limits limits_;
    std::uint64_t bytes_ = 1ull << 40; // so that the limits alone bound the child
    std::map<std::string, std::string> companions_;
    std::vector<std::string> asked_;
};

TEST_F(RunImport, ImportsAMeshWithTheFilesThatItNames)
{
    companions_["a.mtl"] = "newmtl red\nKd 1 0 0\nmap_Kd red.png\n";
    const auto end = run("mtllib a.mtl\nmtllib b.mtl\nmtllib a.mtl\nusemtl red\n" + kTriangle);
    ASSERT_EQ(code(end), "ok");
    const auto& asset = std::get<ImportedAsset>(*end.outcome);
    EXPECT_EQ(asset.format, "obj");
    EXPECT_EQ(asset.mesh.triangles.size(), 1u);
    EXPECT_EQ(asset.mesh.materials[0].diffuse, (renderer::Rgb{1, 0, 0}));
    EXPECT_THAT(asset.notes,
                testing::ElementsAre(testing::HasSubstr("red.png"), testing::HasSubstr("b.mtl")));
    EXPECT_THAT(asked_, testing::ElementsAre("a.mtl", "red.png", "b.mtl")); // each once
    EXPECT_GT(end.peak_bytes, 0u);
    EXPECT_TRUE(end.repeatable);
}

TEST_F(RunImport, ReadsTheSameKnotFromEveryFormat)
{
    for (const std::string name : {"knot.obj",
                                   "knot.ply",
                                   "knot_ascii.ply",
                                   "knot.stl",
                                   "knot_ascii.stl",
                                   "knot.glb",
                                   "knot.gltf",
                                   "knot.fbx",
                                   "knot.dae",
                                   "knot.3ds",
                                   "knot.off"}) {
        companions_["knot.bin"] = tests::bytes_of(fs::path(tests::asset_dir()) / "knot.bin");
        const auto end = run(tests::bytes_of(fs::path(tests::asset_dir()) / name));
        ASSERT_EQ(code(end), "ok") << name;
        EXPECT_EQ(std::get<ImportedAsset>(*end.outcome).mesh.triangles.size(), 6144u) << name;
    }
}

TEST_F(RunImport, TellsWhyForEveryBrokenFile)
{
    const fs::path broken = fs::path(tests::asset_dir()) / "broken";
    std::istringstream manifest(tests::bytes_of(broken / "manifest.tsv"));
    int files = 0;
    for (std::string line; std::getline(manifest, line); ++files) {
        std::istringstream fields(line);
        std::string name, codes;
        std::getline(std::getline(fields, name, '\t'), codes, '\t');
        const auto end = run(tests::bytes_of(broken / name), fs::path(name).extension());
        EXPECT_NE(("," + codes + ",").find("," + code(end) + ","), std::string::npos)
            << name << " gave " << code(end);
    }
    EXPECT_GT(files, 50);
}

TEST_F(RunImport, AsksForNoFileOutsideTheJob)
{
    const std::string traps =
        "mtllib ../../../../etc/passwd\nmtllib /etc/passwd\nmtllib file:///etc/passwd\nmtllib a/../../b\n";
    const auto end = run(traps + kTriangle, ".obj");
    EXPECT_EQ(code(end), "ok");
    EXPECT_TRUE(std::get<ImportedAsset>(*end.outcome).mesh.materials.empty());
    EXPECT_THAT(asked_, testing::IsEmpty());
    for (const char* name : {"uri_passwd.gltf", "uri_absolute.gltf", "uri_http.gltf"}) {
        const auto refused = run(tests::bytes_of(fs::path(tests::asset_dir()) / "broken" / name), ".gltf");
        EXPECT_EQ(code(refused), "missing_file") << name;
    }
    EXPECT_THAT(asked_, testing::IsEmpty());
}

TEST_F(RunImport, StopsAnImportThatTakesTooMuchMemory)
{
#ifdef HELIOGRAPH_SANITIZED
    GTEST_SKIP() << "the address space is not bounded in sanitizer builds";
#endif
    std::string obj;
    for (int i = 0; i < 1'000'000; ++i)
        obj += "v 1 2 3\n";
    for (int i = 0; i < 2'000'000; ++i)
        obj += "f 1 2 3\n";
    limits_.import_memory_bytes = 64u << 20;
    const auto end = run(obj, ".obj");
    EXPECT_EQ(code(end), "import_out_of_memory");
    EXPECT_FALSE(end.repeatable);
    EXPECT_THAT(std::get<ImportFailure>(*end.outcome).detail,
                testing::HasSubstr("--limit-import-memory-bytes"));
}

TEST_F(RunImport, GivesAChildNoMoreThanItsFilesJustify)
{
    bytes_ = 1u << 20;
    misbehave("echo $2 $4 $5 $6 >&2; exit 7");
    EXPECT_EQ(run(kTriangle).log, "50000000 281018368 281018368 11\n");
}

TEST_F(RunImport, HandsAMeshOverWithoutACopy)
{
    const auto end = run(tests::bytes_of(fs::path(tests::asset_dir()) / "knot.ply"));
    ASSERT_EQ(code(end), "ok");
    const renderer::Mesh& mesh = std::get<ImportedAsset>(*end.outcome).mesh;
    EXPECT_TRUE(mesh.positions.is_lent() && mesh.normals.is_lent() && mesh.triangles.is_lent());
}

TEST_F(RunImport, RefusesAnImportedFormOverTheLimit)
{
    limits_.import_output_bytes = 100;
    EXPECT_EQ(code(run(kTriangle, ".obj")), "over_limit");
}

TEST_F(RunImport, SurvivesChildrenThatMisbehave)
{
    const std::map<std::string, std::string> scripts{
        {"kill -SEGV $$", "import_crashed"},
        {"kill -ABRT $$", "import_crashed"},
        {"kill -SYS $$", "import_crashed"},
        {"kill -KILL $$", "import_out_of_memory"},
        {"kill -XFSZ $$", "over_limit"},
        {"kill -XCPU $$", "import_timeout"},
        {"exit 7", "import_crashed"},
        {"exit 4", "import_out_of_memory"},
        {"exit 0", "import_crashed"},
        {"echo no mesh >&4", "import_crashed"},
        {"head -c 100000 /dev/zero >&4", "import_crashed"},
        {"echo nonsense >&5; exit 7", "import_crashed"},
        {"exec 5>&-; exec 2>&-; echo x >&4", "import_crashed"},
    };
    for (const auto& [script, expected] : scripts) {
        misbehave(script);
        EXPECT_EQ(code(run(kTriangle)), expected) << script;
    }
}

TEST_F(RunImport, KillsAChildThatDoesNotEnd)
{
    limits_.import_s = 1;
    for (const char* script : {"while :; do :; done", "while :; do echo noise >&2; done"}) {
        misbehave(script);
        const auto end = run(kTriangle);
        EXPECT_EQ(code(end), "import_timeout") << script;
        EXPECT_FALSE(end.repeatable);
        EXPECT_LE(end.log.size(), 4096u);
    }
}

TEST_F(RunImport, GivesTheChildAllTheTimeThatTheLimitNames)
{
    limits_.import_s = 7200;
    misbehave("echo cpu_s=$6 >&2; exit 7");
    EXPECT_THAT(run(kTriangle).log, testing::HasSubstr("cpu_s=7200"));
}

TEST_F(RunImport, StopsWhenAsked)
{
    misbehave("while :; do :; done");
    std::stop_source stop;
    std::jthread asks([&] { stop.request_stop(); });
    EXPECT_EQ(code(run(kTriangle, "", stop.get_token())), "stopped");
    EXPECT_EQ(code(run(kTriangle, "", stop.get_token())), "stopped"); // asked before it began
}

TEST_F(RunImport, GivesTheChildNothingButWhatItNeeds)
{
    ::setenv("HELIOGRAPH_TEST_SECRET", "secret", 1);
    const FileDescriptor leaky(::open("/dev/null", O_RDONLY)); // without O_CLOEXEC, as a library might
    misbehave("ls -l /proc/self/fd >&2; /usr/bin/env >&2; exit 7");
    const auto end = run(kTriangle);
    EXPECT_THAT(end.log, testing::Not(testing::HasSubstr("secret")));
    // 0 to 5, and the one that ls has open on the folder itself.
    for (const char* fd : {" 0 ->", " 1 ->", " 2 ->", " 3 ->", " 4 ->", " 5 ->"})
        EXPECT_THAT(end.log, testing::HasSubstr(fd));
    EXPECT_THAT(end.log, testing::Not(testing::HasSubstr(" 7 ->"))) << end.log;
}

TEST_F(RunImport, SaysThatAProgramThatIsNotThereIsNotTheFilesFault)
{
    program_ = folder_.path() / "gone";
    EXPECT_THROW(run(kTriangle), std::system_error);
    misbehave("exit 3"); // cannot lock itself down
    EXPECT_THROW(run(kTriangle), std::system_error);
}

TEST_F(RunImport, LeavesNoDescriptorAndNoChildBehind)
{
    const auto descriptors = [] {
        return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
    };
    const auto before = descriptors();
    misbehave("kill -SEGV $$");
    for (int i = 0; i < 50; ++i)
        EXPECT_EQ(code(run(kTriangle)), "import_crashed");
    program_ = kImporter;
    for (int i = 0; i < 25; ++i)
        EXPECT_EQ(code(run("mtllib gone.mtl\nv 0 0 0\n", ".obj")), "no_triangles");
    program_ = folder_.path() / "gone";
    for (int i = 0; i < 25; ++i)
        EXPECT_THROW(run(kTriangle), std::system_error);
    EXPECT_EQ(descriptors(), before);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
}

} // namespace
