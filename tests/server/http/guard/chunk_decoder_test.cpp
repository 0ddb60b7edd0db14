#include "server/http/guard/chunk_decoder.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace {

using server::ChunkDecoder;

// Fed in pieces of `step` bytes. False where the decoder refused.
bool decode(std::string_view raw, std::size_t step, std::string& out, ChunkDecoder& decoder)
{
    while (!raw.empty()) {
        std::string_view piece = raw.substr(0, step);
        raw.remove_prefix(piece.size());
        if (!decoder.decode(piece, out)) return false;
        if (decoder.finished()) return true;
    }
    return true;
}

TEST(ChunkDecoder, GivesTheSameDataHoweverTheBytesAreCut)
{
    const std::string raw = "5\r\nhello\r\nA;name=value\r\n, world!!!\r\n0\r\nTrailer: x\r\n\r\n";
    for (std::size_t step = 1; step <= raw.size(); ++step) {
        ChunkDecoder decoder;
        std::string out;
        ASSERT_TRUE(decode(raw, step, out, decoder)) << step;
        EXPECT_EQ(out, "hello, world!!!");
        EXPECT_TRUE(decoder.finished());
    }
}

TEST(ChunkDecoder, LeavesWhatComesAfterTheBody)
{
    ChunkDecoder decoder;
    std::string out;
    std::string_view raw = "1\r\nx\r\n0\r\n\r\nGET / HTTP/1.1";
    ASSERT_TRUE(decoder.decode(raw, out));
    EXPECT_EQ(raw, "GET / HTTP/1.1");
}

TEST(ChunkDecoder, RefusesSizesThatAreNone)
{
    for (const char* raw : {"-2\r\n",
                            "FFFFFFFFFFFFFFFE\r\n",
                            "FFFFFFFFFFFFFFFFF\r\n",
                            "\r\n",
                            "g\r\n",
                            "0x5\r\n",
                            " 5\r\n",
                            "5\n",
                            "+5\r\n",
                            "5 5x\n"}) {
        ChunkDecoder decoder;
        std::string out;
        EXPECT_FALSE(decode(raw, 1, out, decoder)) << raw;
        EXPECT_EQ(out, "");
    }
}

TEST(ChunkDecoder, RefusesDataThatDoesNotEndWhereItsSizeSays)
{
    ChunkDecoder decoder;
    std::string out;
    EXPECT_FALSE(decode("3\r\nhello\r\n0\r\n\r\n", 100, out, decoder));
}

TEST(ChunkDecoder, IsBoundedInLinesAndTrailers)
{
    ChunkDecoder sizes;
    std::string out;
    EXPECT_FALSE(decode("1;" + std::string(300, 'x'), 16, out, sizes));
    ChunkDecoder trailers;
    std::string many = "0\r\n";
    for (int i = 0; i < 1000; ++i)
        many += "Trailer: of some length\r\n";
    EXPECT_FALSE(decode(many, 1000, out, trailers));
}

} // namespace
