#include "renderer/io/json_scan.h"
#include "renderer/io/text.h"

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <sstream>
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

// The short way of reading a number has no say in what it is.
TEST(Text, ReadsEveryDecimalAsTheLibraryDoes)
{
    std::uint64_t state = 88172645463325252u;
    const auto random = [&](std::uint64_t most) {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        return state % most;
    };
    for (int round = 0; round < 200'000; ++round) {
        std::string word = random(2) ? "-" : "";
        for (std::uint64_t digits = 1 + random(12); digits-- > 0;)
            word += static_cast<char>('0' + random(10));
        if (random(4)) word += '.';
        if (word.back() == '.')
            for (std::uint64_t digits = random(14); digits-- > 0;)
                word += static_cast<char>('0' + random(10));
        if (random(4) == 0) word += (random(2) ? "e-" : "E+") + std::to_string(random(30));
        if (round % 16 == 0) { // half way between two floats, and the doubles beside that
            const double half = 1 + 0x1p-24 + static_cast<double>(random(1u << 20)) * 0x1p-23;
            std::ostringstream text;
            text.precision(17);
            text << std::nextafter(half, static_cast<double>(random(3)));
            word = text.str();
        }
        float expected = 0;
        const auto parsed = std::from_chars(word.data(), word.data() + word.size(), expected);
        if (parsed.ec != std::errc()) continue;
        ASSERT_EQ(renderer::parse_float(word), expected) << word;
        std::string_view line = word;
        ASSERT_EQ(renderer::take_float(line), expected) << word;
        ASSERT_TRUE(line.empty()) << word;
    }
}

TEST(Text, TakesNumbersOnlyWhereTheyEnd)
{
    std::string_view line = " 1.5\t-2e3 7x 8";
    EXPECT_EQ(renderer::take_float(line), 1.5f);
    EXPECT_EQ(renderer::take_float(line), -2000.0f);
    EXPECT_FALSE(renderer::take_float(line));
    EXPECT_EQ(renderer::take_float(line), 8.0f);
    EXPECT_FALSE(renderer::take_float(line));
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
