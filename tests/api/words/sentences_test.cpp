#include "api/words/sentences.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

const std::vector<std::string> kMembers{
    "position", "look_at", "direction", "up", "fov_deg", "type", "color", "radius"};

TEST(Nearest, FindsTheSlipOfAFinger)
{
    EXPECT_EQ(api::nearest("postion", kMembers), "position");
    EXPECT_EQ(api::nearest("poistion", kMembers), "position") << "neighbours swapped";
    EXPECT_EQ(api::nearest("lookat", kMembers), "look_at");
    EXPECT_EQ(api::nearest("colour", kMembers), "color");
    EXPECT_EQ(api::nearest("Position", kMembers), "position");
    EXPECT_EQ(api::nearest("raduis", kMembers), "radius");
}

TEST(Nearest, TakesTheBeginningOfAWord)
{
    EXPECT_EQ(api::nearest("fov", kMembers), "fov_deg");
    EXPECT_EQ(api::nearest("color_rgb", kMembers), "color");
}

TEST(Nearest, StaysSilentWhereNothingIsNear)
{
    EXPECT_FALSE(api::nearest("environment", kMembers));
    EXPECT_FALSE(api::nearest("", kMembers));
    EXPECT_FALSE(api::nearest("xx", kMembers)) << "every letter of \"up\" would be another";
    EXPECT_FALSE(api::nearest(std::string(100'000, 'p'), kMembers));
    EXPECT_FALSE(api::nearest("a", {}));
}

TEST(Shortened, CutsBetweenCharacters)
{
    EXPECT_EQ(api::shortened("abc", 3), "abc");
    EXPECT_EQ(api::shortened("abcd", 3), "abc...");
    EXPECT_EQ(api::shortened("a\xc3\xa9z", 2), "a...");
}

TEST(Listed, StaysShort)
{
    EXPECT_EQ(api::listed(std::vector<std::string>{}), "none");
    EXPECT_EQ(api::listed(std::vector<std::string>{"a", "b"}), "a, b");
    const std::string list = api::listed(std::vector<std::string>(1000, "word"));
    EXPECT_LT(list.size(), 200u);
    EXPECT_EQ(list.substr(list.size() - 5), ", ...");
}

TEST(Utf8, IsToldFromWhatIsNot)
{
    for (const char* good :
         {"", "a", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xef\xbf\xbf", "\xf4\x8f\xbf\xbf"})
        EXPECT_TRUE(api::is_utf8(good)) << good;
    for (const char* bad : {"\x80",
                            "\xc3",
                            "\xc0\xaf",
                            "\xe0\x80\x80",
                            "\xed\xa0\x80",
                            "\xf0\x80\x80\x80",
                            "\xf4\x90\x80\x80",
                            "\xf5\x80\x80\x80",
                            "\xff",
                            "a\xe9"})
        EXPECT_FALSE(api::is_utf8(bad)) << bad;
}

} // namespace
