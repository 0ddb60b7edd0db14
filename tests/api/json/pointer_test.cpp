#include "api/json/pointer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

TEST(Pointer, EscapesTildeAndSlash)
{
    EXPECT_EQ(api::pointer_to("", "scene"), "/scene");
    EXPECT_EQ(api::pointer_to("/a", "m~n/o"), "/a/m~0n~1o");
    EXPECT_EQ(api::pointer_to("/a", ""), "/a/");
    EXPECT_EQ(api::pointer_to("/a", std::size_t{12}), "/a/12");
}

TEST(Pointer, OrdersIndicesAsNumbersAndParentsFirst)
{
    std::vector<std::string> pointers{"/b", "/a/10/x", "/a/2", "", "/a/10", "/a", "/a/2/z", "/aa", "/a/b"};
    std::sort(pointers.begin(), pointers.end(), [](const auto& a, const auto& b) {
        return api::comes_before(a, b);
    });
    const std::vector<std::string> expected{
        "", "/a", "/a/2", "/a/2/z", "/a/10", "/a/10/x", "/a/b", "/aa", "/b"};
    EXPECT_EQ(pointers, expected);
}

TEST(Pointer, KnowsWhatLiesWithin)
{
    EXPECT_TRUE(api::is_within("/a/b", "/a"));
    EXPECT_TRUE(api::is_within("/a", "/a"));
    EXPECT_TRUE(api::is_within("/a", ""));
    EXPECT_FALSE(api::is_within("/ab", "/a"));
    EXPECT_FALSE(api::is_within("/a", "/a/b"));
}

} // namespace
