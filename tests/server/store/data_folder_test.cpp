#include "server/store/data_folder.h"
#include "server/store/store.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <memory>

namespace {

using server::DataFolder;

std::string refusal_of(const std::filesystem::path& path)
{
    try {
        const DataFolder folder(path);
        return "(none)";
    } catch (const server::StoreError& error) {
        return error.what();
    }
}

TEST(DataFolder, IsMadeWithItsParentsAndHeldByOne)
{
    const tests::TempFolder temp;
    const auto path = temp.path() / "deep" / "data";
    {
        const DataFolder folder(path);
        EXPECT_TRUE(std::filesystem::is_directory(path));
        EXPECT_EQ(folder.path(), path);
        EXPECT_NE(refusal_of(path).find(path.string()), std::string::npos) << refusal_of(path);
        EXPECT_NE(refusal_of(path.string() + "/").find("in use"), std::string::npos);
        EXPECT_EQ(refusal_of(temp.path() / "deep" / "other"), "(none)");
    }
    EXPECT_EQ(refusal_of(path), "(none)") << "free again";
}

TEST(DataFolder, SaysWhichFolderCannotBeMade)
{
    const tests::TempFolder temp;
    temp.write("file", "x");
    for (const auto& path : {temp.path() / "file", temp.path() / "file" / "below"})
        EXPECT_NE(refusal_of(path).find((temp.path() / "file").string()), std::string::npos)
            << refusal_of(path);
}

TEST(DataFolder, IsNotTriedForEverWhereNothingCanBeMade)
{
    for (const char* path : {"/proc/absent", "/proc/absent/data"}) // mkdir says ENOENT, though /proc is there
        EXPECT_NE(refusal_of(path).find("cannot make the folder /proc/absent"), std::string::npos)
            << refusal_of(path);
}

} // namespace
