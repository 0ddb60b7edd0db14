#include "tests/server/http/guard/guarded.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace {

using server::GuardOptions;
using test_support::fetch;
using test_support::RawConnection;
using tests::Guarded;
using tests::kLargeRest;
using tests::kLargeStart;

TEST_F(Guarded, ServesManyRequestsOnOneConnectionAlsoSentAhead)
{
    RawConnection connection(port);
    std::string ahead;
    for (int i = 0; i < 20; ++i)
        ahead += "POST /read HTTP/1.1\r\nHost: a\r\nContent-Length: 2\r\n\r\n" + std::to_string(10 + i);
    ASSERT_TRUE(connection.send(ahead));
    for (int i = 0; i < 20; ++i) {
        const auto answer = connection.read();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->body, std::to_string(10 + i));
    }
}

TEST_F(Guarded, GivesHandlersTheHeadersAsTheyWereSentAndNoForgedOnes)
{
    const auto answer = fetch(port,
                              "POST",
                              "/headers",
                              {{"REMOTE_ADDR", "6.6.6.6"},
                               {"X-Odd", "a%2Bb%0d%0aX: y"},
                               {"Content-Type", "multipart/form-data"},
                               {"Body-Type", "forged"},
                               {"Range", "bytes=0-1,0-1"},
                               {"Accept-Encoding", "gzip"}});
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.body.rfind("127.0.0.1\n", 0), 0u);
    EXPECT_EQ(answer.body.find("6.6.6.6"), std::string::npos);
    EXPECT_NE(answer.body.find("X-Odd=a%2Bb%0d%0aX: y\n"), std::string::npos);
    EXPECT_NE(answer.body.find("Body-Type=multipart/form-data\n"), std::string::npos);
    EXPECT_EQ(answer.body.find("forged"), std::string::npos);
    EXPECT_FALSE(answer.has("content-encoding"));
}

TEST_F(Guarded, PutsChunkedBodiesTogetherAndKeepsTheConnection)
{
    RawConnection connection(port);
    ASSERT_TRUE(connection.send("POST /read HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: "
                                "chunked\r\n\r\n5\r\nhello\r\n1;x=y\r\n!\r\n0\r\nT: x\r\n\r\n"));
    auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body, "hello!");
    ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body, "ok");
}

TEST_F(Guarded, RefusesChunksThatAreNone)
{
    for (const char* size : {"-2", "FFFFFFFFFFFFFFFE", "FFFFFFFFFFFFFFFFF", "zz"}) {
        RawConnection connection(port);
        connection.send(std::string("POST /read HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n") +
                        size + "\r\nabc");
        const auto answer = connection.read();
        ASSERT_TRUE(answer) << size;
        EXPECT_EQ(answer->status, 400);
        EXPECT_EQ(answer->header("connection"), "close");
        EXPECT_TRUE(connection.wait_closed());
    }
    expect_alive();
}

TEST_F(Guarded, SaysContinueOnlyWhenAHandlerReads)
{
    RawConnection reads(port);
    ASSERT_TRUE(
        reads.send("POST /read HTTP/1.1\r\nHost: a\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\n"));
    auto answer = reads.read_head();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 100);
    ASSERT_TRUE(reads.send("hi"));
    answer = reads.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body, "hi");

    RawConnection refuses(port);
    ASSERT_TRUE(
        refuses.send("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\n"));
    answer = refuses.read_head();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200);
    EXPECT_EQ(answer->header("connection"), "close");
}

TEST_F(Guarded, ClosesAfterAnAnswerThatCameBeforeTheBody)
{
    RawConnection connection(port);
    ASSERT_TRUE(connection.send("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 100000\r\n\r\nGET /smuggled "
                                "HTTP/1.1\r\nHost: a\r\n\r\n" +
                                std::string(70000, 'x')));
    const auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->header("connection"), "close");
    EXPECT_FALSE(connection.read());
}

TEST_F(Guarded, RefusesHeadersBeyondItsBoundsAndGoesOn)
{
    RawConnection line(port);
    line.send("GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(300 << 10, 'a'));
    auto answer = line.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 431);
    EXPECT_EQ(answer->header("content-type"), "application/problem+json");
    EXPECT_NE(answer->header("x-request-id"), "");

    std::string many = "GET / HTTP/1.1\r\nHost: a\r\n";
    for (int i = 0; i < 200; ++i)
        many += "X: a\r\n";
    RawConnection lines(port);
    lines.send(many + "\r\n");
    answer = lines.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 431);
    expect_alive();
}

TEST_F(Guarded, AnswersGarbageWithAProblemAndUnknownMethodsWith405)
{
    RawConnection garbage(port);
    garbage.send("\x16\x03\x01\x02 tls, perhaps\r\n\r\n");
    auto answer = garbage.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 400);
    EXPECT_NE(answer->body.find("\"code\":\"bad_request\""), std::string::npos) << answer->body;
    const auto brew = fetch(port, "BREW", "/");
    EXPECT_EQ(brew.status, 405);
    EXPECT_NE(brew.header("allow").find("GET"), std::string::npos);
    expect_alive();
}

TEST_F(Guarded, TellsNobodyWhatAnExceptionSaid)
{
    const auto answer = fetch(port, "GET", "/throw", {{"X-Request-Id", "mine-1"}});
    EXPECT_EQ(answer.status, 500);
    EXPECT_EQ(answer.body.find("secret"), std::string::npos);
    for (const auto& [name, value] : answer.headers)
        EXPECT_EQ(value.find("secret"), std::string::npos) << name;
    EXPECT_EQ(answer.header("x-request-id"), "mine-1");
    EXPECT_EQ(answer.header("content-type"), "application/problem+json");
    EXPECT_EQ(answer.header("x-content-type-options"), "nosniff");
}

TEST_F(Guarded, RefusesRequestsBeyondThreadsAndQueue)
{
    GuardOptions options;
    options.threads = 1;
    options.queue = 1;
    restart(options);
    RawConnection holds(port);
    ASSERT_TRUE(holds.send("GET /wait HTTP/1.1\r\nHost: a\r\n\r\n"));
    began.get_future().wait();
    RawConnection waits(port);
    ASSERT_TRUE(waits.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    ASSERT_TRUE(comes_to_pass([](const auto& load) { return load.queued == 1; }));
    RawConnection refused(port);
    ASSERT_TRUE(refused.send("GET / HTTP/1.1\r\nHost: a\r\nX-Request-Id: mine-2\r\n\r\n"));
    const auto answer = refused.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 503);
    EXPECT_EQ(answer->header("retry-after"), "1");
    EXPECT_EQ(answer->header("x-request-id"), "mine-2");
    holds.hang_up();
    const auto served = waits.read();
    ASSERT_TRUE(served);
    EXPECT_EQ(served->body, "ok");
}

TEST_F(Guarded, LetsOneClientHaveAFewLargeBodiesOnTheirWayAndNoMore)
{
    GuardOptions options;
    options.body_threads = 3;
    options.bodies_per_client = 2;
    restart(options);
    const std::string chunks = "POST /read HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n";
    RawConnection first(port), second(port);
    ASSERT_TRUE(first.send(kLargeStart));
    ASSERT_TRUE(second.send(chunks + "11170\r\n" + std::string(70000, 'x') + "\r\n"));
    while (reading < 2)
        std::this_thread::yield();
    RawConnection third(port);
    ASSERT_TRUE(third.send(kLargeStart));
    const auto refusal = third.read();
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->status, 429);
    EXPECT_EQ(refusal->header("retry-after"), "1");
    EXPECT_NE(refusal->body.find("too_many_bodies"), std::string::npos) << refusal->body;
    RawConnection other(port, 0, "127.0.0.2");
    ASSERT_TRUE(other.send(kLargeStart + kLargeRest));
    EXPECT_EQ(other.read().value().body.size(), 100000u) << "another client has places of its own";

    ASSERT_TRUE(first.send(kLargeRest));
    EXPECT_EQ(first.read().value().body.size(), 100000u);
    RawConnection next(port); // has the place of the first, whose connection stays
    ASSERT_TRUE(next.send(kLargeStart + kLargeRest));
    EXPECT_EQ(next.read().value().body.size(), 100000u);
    ASSERT_TRUE(second.send("0\r\n\r\n"));
    EXPECT_EQ(second.read().value().body.size(), 70000u);
}

TEST_F(Guarded, EndsTheWaitOfAClientThatHangsUp)
{
    RawConnection connection(port);
    ASSERT_TRUE(connection.send("GET /wait HTTP/1.1\r\nHost: a\r\n\r\n"));
    began.get_future().wait();
    connection.hang_up();
    EXPECT_EQ(ended.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
}

TEST_F(Guarded, ServesManyConnectionsAtOnce)
{
    GuardOptions options;
    options.threads = 8;
    restart(options);
    std::vector<std::unique_ptr<RawConnection>> connections;
    for (int i = 0; i < 200; ++i)
        connections.push_back(std::make_unique<RawConnection>(port));
    for (auto& connection : connections)
        ASSERT_TRUE(connection->send("GET / HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n"));
    for (auto& connection : connections) {
        const auto answer = connection->read();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->body, "ok");
    }
}

} // namespace
