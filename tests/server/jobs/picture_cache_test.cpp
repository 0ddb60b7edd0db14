#include "server/jobs/picture_cache.h"

#include <gtest/gtest.h>

namespace {

using server::PictureCache;
using server::PngBytes;

PngBytes picture(std::size_t bytes)
{
    return std::make_shared<const std::vector<std::byte>>(bytes);
}

TEST(PictureCache, GivesBackWhatItWasGiven)
{
    PictureCache cache(100);
    EXPECT_FALSE(cache.find("a"));
    const PngBytes png = picture(10);
    cache.put("a", png);
    EXPECT_EQ(cache.find("a"), png);
    cache.put("a", picture(10));
    EXPECT_EQ(cache.find("a"), png) << "one digest, one picture";
}

TEST(PictureCache, LetsGoOfWhatWasUsedLongestAgo)
{
    PictureCache cache(100);
    for (const char* digest : {"a", "b", "c"})
        cache.put(digest, picture(30));
    EXPECT_TRUE(cache.find("a"));
    cache.put("d", picture(30));
    EXPECT_FALSE(cache.find("b"));
    EXPECT_TRUE(cache.find("a") && cache.find("c") && cache.find("d"));
    cache.put("e", picture(100));
    EXPECT_TRUE(cache.find("e"));
    EXPECT_FALSE(cache.find("a") || cache.find("c") || cache.find("d"));
}

TEST(PictureCache, TakesNothingThatDoesNotFit)
{
    PictureCache cache(100);
    cache.put("a", picture(60));
    cache.put("big", picture(101));
    cache.put("none", nullptr);
    EXPECT_FALSE(cache.find("big") || cache.find("none"));
    EXPECT_TRUE(cache.find("a")) << "and lets nothing go for it";
}

} // namespace
