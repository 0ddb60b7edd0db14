#include "clients/cli/files.h"
#include "clients/cli/mesh_files.h"
#include "clients/cli/user_error.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <iterator>

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
