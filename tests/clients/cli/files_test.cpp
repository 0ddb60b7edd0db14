#include "clients/cli/files.h"
#include "clients/cli/mesh_files.h"
#include "clients/cli/user_error.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <filesystem>
#include <iterator>
#include <string>
#include <unistd.h>

namespace {

using tests::TempFolder;

TEST(Files, WriteWholeOnesAndLeaveNothingElse)
{
    const TempFolder folder;
    clients::write_file(folder.file("a"), "one");
    clients::write_file(folder.file("a"), "two");
    EXPECT_EQ(clients::read_file(folder.file("a")), "two");
    const auto entries = std::filesystem::directory_iterator(folder.path());
    EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
    EXPECT_THROW(clients::write_file(folder.file("absent/a"), "x"), clients::UserError);
    EXPECT_THROW(clients::read_file(folder.file("absent")), clients::UserError);
    EXPECT_THROW(clients::read_file(folder.path()), clients::UserError) << "a folder";
    EXPECT_THROW(clients::check_writable(folder.file("absent/a")), clients::UserError);
    EXPECT_THROW(clients::check_writable(folder.path()), clients::UserError);
}

// In a process of its own, where need be as a user who may write to no system folder.
[[noreturn]] void check_as_ordinary_user(const char* path)
{
    if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(3);
    try {
        clients::check_writable(path);
    } catch (const clients::UserError&) {
        _exit(1);
    }
    _exit(0);
}

TEST(FilesDeathTest, TakeADeviceThatMayBeWrittenInAFolderThatMayNot)
{
    EXPECT_EXIT(check_as_ordinary_user("/dev/null"), testing::ExitedWithCode(0), "");
    EXPECT_EXIT(check_as_ordinary_user("/dev/mem"), testing::ExitedWithCode(1), "");
    EXPECT_EXIT(check_as_ordinary_user("/dev/new"), testing::ExitedWithCode(1), "");
}

TEST(Files, AreWrittenThroughADescriptorsNameAndDoNotReplaceIt)
{
    const TempFolder folder;
    const std::string target = folder.file("target");
    const int fd = open(target.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    const std::filesystem::path name = "/proc/self/fd/" + std::to_string(fd);
    std::filesystem::create_symlink(name, folder.path() / "stdout"); // as /dev/stdout is one
    clients::check_writable(folder.path() / "stdout");
    clients::write_file(folder.path() / "stdout", "text");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "stdout"));
    EXPECT_EQ(tests::bytes_of(target), "text");
    close(fd);
}

TEST(FolderFiles, OpenOnlyWhatLiesWithinTheFolder)
{
    const TempFolder folder;
    folder.write("secret.txt", "secret");
    folder.write("meshes/a.mtl", "newmtl a");
    folder.write("meshes/textures/b.png", "png");
    clients::FolderFiles files(folder.path() / "meshes");
    ASSERT_TRUE(files.open("a.mtl"));
    EXPECT_EQ(files.open("a.mtl")->size(), 8u);
    EXPECT_TRUE(files.open("./a.mtl"));
    EXPECT_TRUE(files.open("textures/../a.mtl"));
    EXPECT_TRUE(files.open("textures/b.png"));
    EXPECT_FALSE(files.open("../secret.txt"));
    EXPECT_FALSE(files.open("textures/../../secret.txt"));
    EXPECT_FALSE(files.open(folder.file("secret.txt")));
    EXPECT_FALSE(files.open("/etc/passwd"));
    EXPECT_FALSE(files.open("textures")) << "a folder";
    EXPECT_FALSE(files.open(".."));
    EXPECT_FALSE(files.open(""));
    EXPECT_FALSE(files.open("absent"));
}

} // namespace
