#include "clients/cli/csv_table.h"
#include "clients/cli/user_error.h"

#include <gtest/gtest.h>

#include <string>

using clients::CsvTable;

namespace {

std::string error_of(const auto& action)
{
    try {
        action();
    } catch (const clients::UserError& error) {
        return error.what();
    }
    return "none";
}

} // namespace

TEST(CsvTable, PassesColumnsThroughAndAddsItsOwn)
{
    CsvTable table("t.csv", "\xEF\xBB\xBF# about\r\n\r\na, b ,note\r\n1,-2.5e1, x \r\n+3,4\r\n");
    ASSERT_EQ(table.rows(), 2u);
    EXPECT_EQ(table.number(0, "b"), -25);
    EXPECT_EQ(table.number(1, "a"), 3);
    EXPECT_EQ(table.text(1, "note"), "");
    EXPECT_EQ(table.text(1, "absent"), "");
    table.set(1, "c", 0.1);
    table.set(0, "b", 7);
    EXPECT_EQ(table.write(), "a,b,note,c\n1,7,x,\n+3,4,,0.1\n");
}

TEST(CsvTable, NamesTheLineOfWhatIsWrong)
{
    const CsvTable table("t.csv", "# about\na,b\n1,two\nnan,4\n");
    EXPECT_EQ(error_of([&] { static_cast<void>(table.number(0, "b")); }),
              "t.csv:3: b: \"two\" is not a number");
    EXPECT_EQ(error_of([&] { static_cast<void>(table.number(1, "a")); }),
              "t.csv:4: a: \"nan\" is not a number");
    EXPECT_EQ(error_of([&] { static_cast<void>(table.column("c")); }),
              "t.csv: there is no column c; there are: a, b");
    EXPECT_EQ(error_of([] { CsvTable("t.csv", "a\n1,2\n"); }), "t.csv:2: 2 cells under 1 columns");
    EXPECT_EQ(error_of([] { CsvTable("t.csv", "a,b,a\n"); }), "t.csv:1: column a stands twice");
    EXPECT_EQ(error_of([] { CsvTable("t.csv", "# only words\n"); }),
              "t.csv: there is no line that names the columns");
}
