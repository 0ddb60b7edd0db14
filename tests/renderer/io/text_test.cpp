#include "renderer/io/json_scan.h"
#include "renderer/io/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using renderer::JsonScan;

TEST(Text, ReadsNumbersToTheLastBit)
{
    EXPECT_EQ(renderer::parse_float("0.1"), 0.1f);
    EXPECT_EQ(renderer::parse_float("+1.5e2"), 150.0f);
    EXPECT_EQ(renderer::parse_float("16777217"), 16777216.0f);
    EXPECT_EQ(renderer::parse_float("-1e39"), -std::numeric_limits<float>::infinity());
    EXPECT_EQ(renderer::parse_float("1e-60"), 0.0f);
    EXPECT_EQ(renderer::parse_float("1e-400"), 0.0f);
    EXPECT_EQ(renderer::parse_float("1e400"), std::numeric_limits<float>::infinity());
    EXPECT_TRUE(std::isnan(renderer::parse_float("nan").value()));
    for (const char* word : {"", "x", "1,5", "1.5f", "--1", "+-1", "1 ", "0x10"})
        EXPECT_FALSE(renderer::parse_float(word)) << word;
    EXPECT_EQ(renderer::parse_integer("-7"), -7);
    for (const char* word : {"", "1.0", "+-7", "99999999999999999999"})
        EXPECT_FALSE(renderer::parse_integer(word)) << word;
}

TEST(Text, GivesLinesWithTheirNumbers)
{
    renderer::Lines lines("a\r\nb \\\nc\n\nd", true);
    EXPECT_EQ(lines.next(), "a");
    EXPECT_EQ(lines.next(), "b  c");
    EXPECT_EQ(lines.number(), 2u);
    EXPECT_EQ(lines.next(), "");
    EXPECT_EQ(lines.number(), 4u);
    EXPECT_FALSE(lines.cut_off());
    EXPECT_EQ(lines.next(), "d");
    EXPECT_TRUE(lines.cut_off());
    EXPECT_FALSE(lines.next());
}

TEST(Text, CleansWhatIsNotUtf8)
{
    EXPECT_EQ(renderer::clean_utf8("a\xc3\xb6\xffz\n\xed\xa0\x80"), "a\xc3\xb6?z????");
    EXPECT_EQ(renderer::clean_utf8("\xc3\xb6\xc3\xb6", 3), "\xc3\xb6"); // never half a character
}

bool is_json(std::string_view text)
{
    JsonScan scan(text);
    return scan.skip() && scan.at_end();
}

TEST(JsonScan, TakesJsonAndNothingElse)
{
    for (const char* text :
         {"{}", "[]", " [1, -0.5e+3, \"a\\\"b\", null, true, {\"a\":[{}]}] ", "0", "\"\\u00e9\""})
        EXPECT_TRUE(is_json(text)) << text;
    for (const char* text : {"",
                             "{",
                             "[1,]",
                             "{\"a\"}",
                             "{a:1}",
                             "[01]",
                             "[1.]",
                             "[-]",
                             "\"\\",
                             "\"\n\"",
                             "nul",
                             "[] x",
                             "{\"a\":1,}"})
        EXPECT_FALSE(is_json(text)) << text;
}

TEST(JsonScan, GoesNoDeeperThanItMay)
{
    EXPECT_TRUE(is_json(std::string(64, '[') + std::string(64, ']')));
    EXPECT_FALSE(is_json(std::string(65, '[') + std::string(65, ']')));
    EXPECT_FALSE(is_json(std::string(1'000'000, '[')));
}

} // namespace
