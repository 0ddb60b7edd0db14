#include "server/jobs/picture_cache.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace {

using server::EncodedPicture;
using server::PictureCache;

EncodedPicture picture(std::size_t bytes)
{
    return {std::make_shared<const std::vector<std::byte>>(bytes), "sha256:" + std::to_string(bytes)};
}

TEST(PictureCache, GivesBackWhatItWasGiven)
{
    PictureCache cache(100);
    EXPECT_FALSE(cache.find("a"));
    const EncodedPicture png = picture(10);
    cache.put("a", png);
    EXPECT_EQ(cache.find("a")->bytes, png.bytes);
    EXPECT_EQ(cache.find("a")->digest, "sha256:10");
    cache.put("a", picture(10));
    EXPECT_EQ(cache.find("a")->bytes, png.bytes) << "one key, one picture";
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
    cache.put("none", {});
    EXPECT_FALSE(cache.find("big") || cache.find("none"));
    EXPECT_TRUE(cache.find("a")) << "and lets nothing go for it";
}

TEST(PictureCache, TellsEncodingsOfOnePictureApart)
{
    std::set<std::string> keys;
    for (const renderer::PictureFormatEntry& entry : renderer::kPictureFormats)
        keys.insert(server::picture_key("sha256:a", {entry.format, 8}));
    keys.insert(server::picture_key("sha256:a", {renderer::PictureFormat::png, 16}));
    keys.insert(server::picture_key("sha256:b", {}));
    for (const renderer::LayerEntry& entry : renderer::kLayers)
        keys.insert(server::picture_key("sha256:a", {}, entry.layer));
    EXPECT_EQ(keys.size(), renderer::kPictureFormats.size() + 2 + renderer::kLayers.size());
}

} // namespace
