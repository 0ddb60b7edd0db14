#include "server/http/byte_range.h"
#include "server/http/exchange.h"
#include "server/http/negotiation.h"
#include "server/http/printable.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace {

using server::ByteRange;

TEST(Prefer, WaitIsReadAmongOtherPreferences)
{
    EXPECT_EQ(server::preferred_wait_s("wait=30"), 30u);
    EXPECT_EQ(server::preferred_wait_s("respond-async, Wait = 5 ; x=y"), 5u);
    EXPECT_EQ(server::preferred_wait_s("wait=0"), 0u);
    EXPECT_EQ(server::preferred_wait_s("wait=99999999999999999999999"), UINT64_MAX);
}

TEST(Prefer, WaitMayStandInQuotes)
{
    EXPECT_EQ(server::preferred_wait_s("wait=\"1\""), 1u);
    EXPECT_EQ(server::preferred_wait_s("wait = \"30\"; x=\"a;b\""), 30u);
    EXPECT_EQ(server::preferred_wait_s(R"(wait="\3\0")"), 30u);
    EXPECT_EQ(server::preferred_wait_s(R"(odd="a, wait=5, \"", wait=7)"), 7u)
        << "what is quoted asks nothing";
}

TEST(Prefer, MalformedWishesAreLeftUnheard)
{
    for (const char* text : {"",
                             "wait",
                             "wait=",
                             "wait=abc",
                             "wait=-1",
                             "wait=1.5",
                             "wait=3s",
                             "wait=1=2",
                             ",,;;,=",
                             "waits=3",
                             "wait=\"",
                             "wait=\"\"",
                             "wait=\"1",
                             "wait=1\"",
                             "wait=\" 1\"",
                             "wait=\"1\"2",
                             "odd=\"a, wait=5",
                             "\\"})
        EXPECT_EQ(server::preferred_wait_s(text), std::nullopt) << text;
}

TEST(Accept, TellsWhetherOnlyPicturesWillDo)
{
    const auto only = [](const char* text) { return server::read_accept(text).only_images; };
    EXPECT_FALSE(only("") || only("*/*") || only("image/png, application/json") || only("application/json"));
    EXPECT_TRUE(only("image/png") && only("IMAGE/*;q=0.5") && only("image/jpeg, image/webp"));
    EXPECT_TRUE(only("image/png, application/json;q=0"));
}

TEST(Accept, ChoosesTheFormatThatSuitsBest)
{
    using renderer::PictureFormat;
    struct Case {
        const char* accept;
        std::optional<PictureFormat> best;
    };
    constexpr PictureFormat png = PictureFormat::png, jpeg = PictureFormat::jpeg, hdr = PictureFormat::hdr,
                            exr = PictureFormat::exr, pfm = PictureFormat::pfm;
    for (const auto& [accept, best] : {
             Case{"", png},
             Case{"*/*", png},
             Case{"*", png},
             Case{"image/*", png},
             Case{"image/png", png},
             Case{"image/jpeg", jpeg},
             Case{"image/vnd.radiance", hdr},
             Case{"Image/X-EXR", exr},
             Case{"image/x-portable-floatmap", pfm},
             Case{"image/jpeg, image/png", png}, // alike: the table's order
             Case{"image/jpeg, image/png;q=0.9", jpeg},
             Case{"image/jpeg;q=0.899, image/png;q=0.9", png},
             Case{"image/*;q=0.1, image/x-exr;q=0.2", exr},
             Case{"image/*, image/png;q=0", jpeg},
             Case{"image/png;q=0.5, */*", jpeg}, // the exact range counts for PNG
             Case{"image/png;q=0.000, image/x-exr ; Q=0.001", exr},
             Case{"image/png;level=1", png},
             Case{"image/png;q=oops", png}, // left unheard
             Case{"image/png;q=1.5, image/jpeg", png},
             Case{"image/avif,image/webp,*/*;q=0.8", png},
             Case{"image/jpeg, application/json", jpeg},
             Case{"image/webp", std::nullopt},
             Case{"application/json", std::nullopt},
             Case{"image/png;q=0", std::nullopt},
             Case{"*/*;q=0", std::nullopt},
         })
        EXPECT_EQ(server::read_accept(accept).best(), best) << accept;
    EXPECT_TRUE(server::read_accept("image/jpeg, image/png;q=0.1").takes(png));
    EXPECT_FALSE(server::read_accept("image/jpeg").takes(png));
}

TEST(Accept, ChoosesAmongTheFormatsThatHoldALayer)
{
    using renderer::Layer;
    using renderer::PictureFormat;
    struct Case {
        const char* accept;
        Layer layer;
        std::optional<PictureFormat> best;
    };
    for (const auto& [accept, layer, best] : {
             Case{"", Layer::depth, PictureFormat::exr},
             Case{"*/*", Layer::normal, PictureFormat::exr},
             Case{"image/*;q=0.5, image/png", Layer::normal, PictureFormat::png},
             Case{"image/*;q=0.5, image/png", Layer::depth, PictureFormat::exr},
             Case{"image/png, image/x-portable-floatmap;q=0.1", Layer::samples, PictureFormat::pfm},
             Case{"image/png", Layer::depth, std::nullopt},
             Case{"image/jpeg, image/vnd.radiance", Layer::albedo, std::nullopt},
         })
        EXPECT_EQ(server::read_accept(accept).best_of(layer), best) << accept;
}

TEST(CacheControl, NoCacheAsksForAFreshRender)
{
    EXPECT_TRUE(server::wants_fresh("max-age=0, No-Cache"));
    EXPECT_FALSE(server::wants_fresh("max-age=0"));
    EXPECT_FALSE(server::wants_fresh(""));
}

TEST(ByteRange, IsReadAsTheStandardSays)
{
    const auto part = [](const char* header, std::uint64_t first, std::uint64_t count) {
        const ByteRange range = server::read_byte_range(header, 100);
        EXPECT_EQ(range.kind, ByteRange::Kind::part) << header;
        EXPECT_EQ(range.first, first) << header;
        EXPECT_EQ(range.count, count) << header;
    };
    part("bytes=0-9", 0, 10);
    part("bytes=90-", 90, 10);
    part("bytes=90-1000", 90, 10);
    part("bytes=-7", 93, 7);
    part("bytes=-1000", 0, 100);
    part("bytes=99-99", 99, 1);
    for (const char* header : {"bytes=100-", "bytes=100-200", "bytes=-0", "bytes=18446744073709551615-"})
        EXPECT_EQ(server::read_byte_range(header, 100).kind, ByteRange::Kind::beyond) << header;
}

TEST(ByteRange, OfManyOrMalformedIsTheWhole)
{
    for (const char* header : {"",
                               "bytes=",
                               "bytes=-",
                               "bytes=5",
                               "bytes=a-b",
                               "bytes=9-5",
                               "items=0-5",
                               "bytes=0-1,2-3",
                               "bytes=0-99999999999999999999",
                               "bytes=--5"})
        EXPECT_EQ(server::read_byte_range(header, 100).kind, ByteRange::Kind::whole) << header;
}

TEST(ETag, IsFoundInListsWeakOrNot)
{
    EXPECT_TRUE(server::names_etag("\"abc\"", "abc"));
    EXPECT_TRUE(server::names_etag("\"x\", W/\"abc\"", "abc"));
    EXPECT_TRUE(server::names_etag("*", "abc"));
    EXPECT_FALSE(server::names_etag("", "abc"));
    EXPECT_FALSE(server::names_etag("abc", "abc"));
    EXPECT_FALSE(server::names_etag("\"abcd\"", "abc"));
}

TEST(ReprDigest, IsTheDigestInBase64)
{
    // printf '' | openssl dgst -sha256 -binary | base64
    EXPECT_EQ(server::repr_digest("sha256:e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"),
              "sha-256=:47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=:");
}

TEST(Printable, ShowsEveryOddByteAsAQuestionMark)
{
    EXPECT_EQ(server::printable("a\x1b[2J\xff"), "a?[2J?");
}

} // namespace
