#include "server/http/guard/request_head.h"

#include <gtest/gtest.h>

#include <string>

namespace {

using server::HeadFault;
using server::RequestHead;

std::string block(const std::string& line, const std::string& fields = "")
{
    return line + "\r\nHost: a\r\n" + fields + "\r\n";
}

int status_of(const std::string& text)
{
    RequestHead head;
    const auto fault = server::read_head(text, head);
    return fault ? fault->status : 200;
}

TEST(RequestHead, HoldsWhatWasSentAndNothingDecoded)
{
    RequestHead head;
    ASSERT_FALSE(server::read_head(block("POST /v1/jobs?a=%20b HTTP/1.1",
                                         "Content-Length: 12\r\nX-Odd:  a%2Bb\t\r\nExpect: 100-Continue\r\n"),
                                   head));
    EXPECT_EQ(head.method, "POST");
    EXPECT_EQ(head.target, "/v1/jobs?a=%20b");
    EXPECT_EQ(head.content_length, 12u);
    EXPECT_TRUE(head.expects_continue);
    EXPECT_FALSE(head.close);
    ASSERT_EQ(head.fields.size(), 4u);
    EXPECT_EQ(head.fields[2].second, "a%2Bb");
    EXPECT_EQ(head.rewritten(), "POST /v1/jobs?a=%20b HTTP/1.1\r\nHost: guard\r\nContent-Length: 12\r\n\r\n");
}

TEST(RequestHead, TakesTheAbsoluteFormThatProxiesSend)
{
    RequestHead head;
    ASSERT_FALSE(server::read_head(block("GET http://example.org:80/healthz HTTP/1.1"), head));
    EXPECT_EQ(head.target, "/healthz");
}

TEST(RequestHead, KeepsARequestIdThatIsOneAndMakesOneOtherwise)
{
    RequestHead head;
    ASSERT_FALSE(server::read_head(block("GET / HTTP/1.1", "X-Request-Id: abc-123_X\r\n"), head));
    EXPECT_EQ(head.request_id, "abc-123_X");
    for (const char* bad : {"a b",
                            "<script>",
                            "",
                            "a%0d%0aSet-Cookie: x",
                            "0123456789012345678901234567890123456789012345678901234567890123456789"}) {
        ASSERT_FALSE(
            server::read_head(block("GET / HTTP/1.1", std::string("X-Request-Id: ") + bad + "\r\n"), head));
        EXPECT_TRUE(server::is_request_id(head.request_id));
        EXPECT_NE(head.request_id, bad);
    }
}

TEST(RequestHead, RefusesWhatTwoReadersCouldReadDifferently)
{
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n")),
              400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length: 5\r\nContent-Length: 5\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length: +5\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length: 5, 5\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length: 99999999999999999999\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length: \r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Transfer-Encoding: gzip, chunked\r\n")), 400);
    EXPECT_EQ(
        status_of(block("POST / HTTP/1.1", "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n")),
        400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length : 5\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", " folded\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "X: a\nContent-Length: 5\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "X: a\rb\r\n")), 400);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", std::string("X: a\0b\r\n", 9))), 400);
    EXPECT_EQ(status_of(block("GET / HTTP/1.1", "Content-Length: 5\r\n")), 400);
    EXPECT_EQ(status_of(block("GET / HTTP/1.1", "Host: b\r\n")), 400);
    EXPECT_EQ(status_of("GET / HTTP/1.1\r\n\r\n"), 400);
    EXPECT_EQ(status_of("GET / HTTP/1.0\r\n\r\n"), 200);
}

TEST(RequestHead, RefusesWhatTheServiceDoesNotSpeak)
{
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Encoding: gzip\r\n")), 415);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Encoding: identity\r\n")), 200);
    EXPECT_EQ(status_of(block("POST / HTTP/1.1", "Content-Length: 1\r\nExpect: miracles\r\n")), 417);
    EXPECT_EQ(status_of(block("GET / HTTP/2.0")), 505);
    EXPECT_EQ(status_of(block("GET  / HTTP/1.1")), 400);
    EXPECT_EQ(status_of(block("GET /")), 400);
    EXPECT_EQ(status_of(block("GET /a#b HTTP/1.1")), 400);
    EXPECT_EQ(status_of(block("GET /\xc3\xa4 HTTP/1.1")), 400);
    EXPECT_EQ(status_of(block("GET nowhere HTTP/1.1")), 400);
    EXPECT_EQ(status_of("\r\n\r\n"), 400);
    EXPECT_EQ(status_of(""), 400);
}

TEST(RequestHead, IsBounded)
{
    EXPECT_EQ(status_of(block("GET /" + std::string(255, 'a') + " HTTP/1.1")), 200);
    EXPECT_EQ(status_of(block("GET /" + std::string(256, 'a') + " HTTP/1.1")), 414);
    EXPECT_EQ(status_of(block("GET /?" + std::string(2046, 'a') + " HTTP/1.1")), 200);
    EXPECT_EQ(status_of(block("GET /?" + std::string(2047, 'a') + " HTTP/1.1")), 414);
    std::string many;
    for (int i = 0; i < 99; ++i)
        many += "X: a\r\n";
    EXPECT_EQ(status_of(block("GET / HTTP/1.1", many)), 200);
    EXPECT_EQ(status_of(block("GET / HTTP/1.1", many + "X: a\r\n")), 431);
}

} // namespace
