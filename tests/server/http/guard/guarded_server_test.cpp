#include "server/http/guard/guarded_server.h"
#include "tests/support/listening_sockets.h"
#include "tests/support/raw_http.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/socket.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

namespace {

using server::GuardedServer;
using server::GuardOptions;
using std::chrono::milliseconds;
using test_support::fetch;
using test_support::RawConnection;

constexpr std::size_t kBig = 256 << 20;

// A server whose handlers do what a test needs, and which says when a waiting one has begun and ended.
class Guarded : public testing::Test {
protected:
    void start(const GuardOptions& options)
    {
        server_ = std::make_unique<GuardedServer>(
            options,
            log_,
            [this](const httplib::Request& request,
                   httplib::Response& response,
                   const httplib::ContentReader* content) { handle(request, response, content); });
        server_->start("127.0.0.1", 0);
        port = server_->port();
    }
    void restart(const GuardOptions& options)
    {
        TearDown();
        start(options);
    }
    // False: it did not come to pass, although a patient client would have gone home by now.
    bool comes_to_pass(const std::function<bool(const GuardedServer::Load&)>& wanted) const
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!wanted(server_->load())) { // asked once: it may pass again
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(milliseconds(5));
        }
        return true;
    }
    void SetUp() override { start({}); }
    void TearDown() override
    {
        if (server_) server_->stop();
    }

    void handle(const httplib::Request& request,
                httplib::Response& response,
                const httplib::ContentReader* content)
    {
        if (request.path == "/throw") throw std::runtime_error("secret path /etc/passwd");
        response.status = 200;
        if (request.path == "/read") {
            std::string body;
            const bool complete = (*content)([&](const char* data, std::size_t size) {
                reading += body.empty() ? 1u : 0u;
                body.append(data, size);
                return true;
            });
            response.status = complete ? 200 : 400;
            response.set_content(complete ? body : "incomplete", "text/plain");
        } else if (request.path == "/headers") {
            std::string text = request.remote_addr + "\n";
            for (const auto& [name, value] : request.headers)
                text += name + "=" + value + "\n";
            response.set_content(text, "text/plain");
        } else if (request.path == "/big") {
            const auto block = std::make_shared<std::string>(1 << 20, 'x');
            response.set_content_provider(kBig,
                                          "application/octet-stream",
                                          [block](std::size_t, std::size_t length, httplib::DataSink& sink) {
                                              return sink.write(block->data(),
                                                                std::min(length, block->size()));
                                          });
        } else if (request.path == "/wait") {
            began.set_value();
            while (request.progress(0, 0))
                std::this_thread::yield();
            ended.set_value();
        } else {
            response.set_content("ok", "text/plain");
        }
    }

    void expect_alive() { EXPECT_EQ(fetch(port, "GET", "/").body, "ok"); }

    server::Log log_{server::LogLevel::error};
    std::unique_ptr<GuardedServer> server_;
    int port = 0;
    std::promise<void> began, ended;
    std::atomic<unsigned> reading = 0; // bodies of which something has been read
};

// The head of a body too large to be waited for, and enough of it for a thread.
const std::string kLargeHead = "PUT /read HTTP/1.1\r\nHost: a\r\nContent-Length: 100000\r\n\r\n";
const std::string kLargeStart = kLargeHead + std::string(70000, 'x');
const std::string kLargeRest(30000, 'x');

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

TEST_F(Guarded, CutsOffWhoSendsAHeaderTooSlowly)
{
    GuardOptions options;
    options.threads = 1;
    options.stream.head = milliseconds(100);
    restart(options);
    RawConnection slow(port);
    ASSERT_TRUE(slow.send("GET / HTTP/1.1\r\nHost: a\r\nX: "));
    const auto answer = slow.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 408);
    expect_alive();
}

TEST_F(Guarded, CutsOffWhoFallsSilentWithinABody)
{
    GuardOptions options;
    options.threads = options.body_threads = 1;
    options.stream.idle_body = milliseconds(100);
    restart(options);
    RawConnection slow(port);
    ASSERT_TRUE(slow.send("POST /read HTTP/1.1\r\nHost: a\r\nContent-Length: 10\r\n\r\nabc"));
    auto answer = slow.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 408);
    EXPECT_TRUE(slow.wait_closed());

    RawConnection large(port);
    ASSERT_TRUE(large.send(kLargeStart));
    answer = large.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 400);
    EXPECT_EQ(answer->body, "incomplete");
    EXPECT_TRUE(large.wait_closed());
    expect_alive();
}

TEST_F(Guarded, CutsOffWhoSendsABodyBelowTheRate)
{
    GuardOptions options;
    options.stream.grace = milliseconds(0);
    options.stream.min_rate = std::uint64_t{1} << 60; // nobody is that fast
    restart(options);
    for (const std::string& start : {kLargeHead + "x", kLargeStart}) {
        RawConnection slow(port);
        ASSERT_TRUE(slow.send(start));
        const auto answer = slow.read();
        ASSERT_TRUE(answer);
        EXPECT_TRUE(answer->status == 408 || answer->status == 400) << answer->status;
        EXPECT_TRUE(slow.wait_closed());
    }
}

TEST_F(Guarded, CutsOffABodyThatTakesTooLongAltogether)
{
    GuardOptions options;
    options.stream.whole_body = milliseconds(100);
    restart(options);
    RawConnection slow(port);
    ASSERT_TRUE(slow.send(kLargeHead));
    while (slow.send("x"))
        std::this_thread::sleep_for(milliseconds(1)); // never silent for long
    EXPECT_TRUE(comes_to_pass([](const auto& load) { return load.connections == 0; }));
}

TEST_F(Guarded, CutsOffWhoDoesNotReadTheAnswer)
{
    GuardOptions options;
    options.threads = 1;
    options.stream.idle_write = milliseconds(100);
    restart(options);
    RawConnection slow(port, 4096);
    ASSERT_TRUE(slow.send("GET /big HTTP/1.1\r\nHost: a\r\n\r\n"));
    ASSERT_TRUE(slow.read_head());
    EXPECT_TRUE(comes_to_pass([](const auto& load) { return load.connections == 0; }));
    EXPECT_LT(slow.read_bytes(kBig), kBig);
}

TEST_F(Guarded, CutsOffWhoReadsTheAnswerBelowTheRate)
{
    GuardOptions options;
    options.stream.grace = milliseconds(0);
    options.stream.min_rate = std::uint64_t{1} << 60; // nobody is that fast
    restart(options);
    RawConnection slow(port, 4096);
    ASSERT_TRUE(slow.send("GET /big HTTP/1.1\r\nHost: a\r\n\r\n"));
    EXPECT_THROW(slow.read(), std::runtime_error); // the body ends early
    expect_alive();
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

// Connections of every slow kind. As many as descriptors allow: both ends are in this process.
class SlowCrowd {
public:
    explicit SlowCrowd(int port)
    {
        for (int i = 0; i < 50; ++i) {
            add(port, "");
            add(port, "GET / HTTP/1.1\r\nHost: a\r\nX: ");
            add(port, "POST /read HTTP/1.1\r\nHost: a\r\nContent-Length: 10\r\n\r\nabc");
            add(port, kLargeHead + "x");
            add(port, "POST /read HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nab");
            idle.push_back(std::make_unique<RawConnection>(port));
            idle.back()->send("GET / HTTP/1.1\r\nHost: a\r\n\r\n");
        }
        for (int i = 0; i < 30; ++i) {
            readers.push_back(std::make_unique<RawConnection>(port, 4096));
            readers.back()->send("GET /big HTTP/1.1\r\nHost: a\r\n\r\n");
            readers.back()->read_head();
        }
        for (const auto& connection : idle)
            connection->read();
    }
    std::size_t size() const { return senders.size() + idle.size() + readers.size(); }

    std::vector<std::unique_ptr<RawConnection>> senders, idle, readers;

private:
    void add(int port, const std::string& bytes)
    {
        senders.push_back(std::make_unique<RawConnection>(port));
        senders.back()->send(bytes);
    }
};

TEST_F(Guarded, HoldsNoThreadForConnectionsThatWait)
{
    GuardOptions options;
    options.threads = 2;
    options.stream.head = options.stream.keep_alive = options.stream.idle_body = options.stream.idle_write =
        options.stream.grace = std::chrono::hours(1);
    restart(options);
    const SlowCrowd crowd(port);
    EXPECT_TRUE(comes_to_pass([&](const auto& load) { return load.parked == crowd.size(); }));
    EXPECT_EQ(server_->load().body_threads, 0u) << "nor of those for large bodies";
    RawConnection waits(port); // one thread of two
    ASSERT_TRUE(waits.send("GET /wait HTTP/1.1\r\nHost: a\r\n\r\n"));
    began.get_future().wait();
    for (int i = 0; i < 20; ++i)
        expect_alive();
    EXPECT_EQ(server_->load().queued, 0u);
    waits.hang_up();
    ended.get_future().wait();
    for (const auto& connection : crowd.idle) { // and each goes on when its client does
        ASSERT_TRUE(connection->send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
        EXPECT_EQ(connection->read().value().body, "ok");
    }
    for (std::size_t i = 0; i < crowd.senders.size(); i += 5) {
        ASSERT_TRUE(crowd.senders[i + 1]->send("y\r\n\r\n"));
        EXPECT_EQ(crowd.senders[i + 1]->read().value().body, "ok");
        ASSERT_TRUE(crowd.senders[i + 2]->send("defghij"));
        EXPECT_EQ(crowd.senders[i + 2]->read().value().body, "abcdefghij");
        ASSERT_TRUE(crowd.senders[i + 4]->send("cde\r\n0\r\n\r\n"));
        EXPECT_EQ(crowd.senders[i + 4]->read().value().body, "abcde");
    }
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(crowd.readers[i]->read_bytes(2 << 20), std::size_t{2} << 20);
}

TEST_F(Guarded, DropsWhateverIsSlowAtItsDeadline)
{
    GuardOptions options;
    options.stream.head = options.stream.keep_alive = options.stream.idle_body = options.stream.idle_write =
        milliseconds(1000);
    restart(options);
    const SlowCrowd crowd(port);
    EXPECT_TRUE(comes_to_pass([](const auto& load) { return load.connections == 0; }));
    for (std::size_t i = 0; i < crowd.senders.size(); ++i) {
        const auto answer = crowd.senders[i]->read();
        if (i % 5 == 0)
            EXPECT_FALSE(answer) << "nothing was asked";
        else if (answer)
            EXPECT_EQ(answer->status, 408);
        else
            ADD_FAILURE() << "no answer to " << i;
    }
    expect_alive();
}

TEST_F(Guarded, DisplacesTheLongestWaitingOfAClientThatHasTooMany)
{
    GuardOptions options;
    options.parking.per_client = 4;
    restart(options);
    std::vector<std::unique_ptr<RawConnection>> mine;
    for (int i = 0; i < 4; ++i) {
        mine.push_back(std::make_unique<RawConnection>(port));
        ASSERT_TRUE(mine.back()->send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
        ASSERT_TRUE(mine.back()->read());
        const std::size_t here = mine.size();
        ASSERT_TRUE(comes_to_pass([&](const auto& load) { return load.parked == here; }));
    }
    RawConnection other(port, 0, "127.0.0.2");
    ASSERT_TRUE(other.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    EXPECT_EQ(other.read().value().body, "ok") << "counts for itself";
    expect_alive(); // the fifth
    EXPECT_FALSE(mine[0]->read()) << "closed for it";
    for (std::size_t i = 1; i < 4; ++i) {
        ASSERT_TRUE(mine[i]->send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
        EXPECT_EQ(mine[i]->read().value().body, "ok");
    }
}

TEST_F(Guarded, LetsNewcomersInWhenACrowdFillsIt)
{
    GuardOptions options;
    options.parking.connections = 20;
    options.stream.head = options.stream.keep_alive = std::chrono::hours(1);
    restart(options);
    std::vector<std::unique_ptr<RawConnection>> crowd;
    for (int i = 0; i < 30; ++i) {
        crowd.push_back(std::make_unique<RawConnection>(port));
        ASSERT_TRUE(crowd.back()->send("GET / HTTP/1.1\r\nX: "));
    }
    RawConnection other(port, 0, "127.0.0.2");
    for (int i = 0; i < 30; ++i) {
        ASSERT_TRUE(other.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
        EXPECT_EQ(other.read().value().body, "ok") << "the crowd displaces its own";
        crowd.push_back(std::make_unique<RawConnection>(port));
    }
    EXPECT_TRUE(comes_to_pass([](const auto& load) { return load.connections == 20; }));
}

TEST_F(Guarded, BoundsWhatWaitingConnectionsHoldInAll)
{
    GuardOptions options;
    options.parking.held_bytes = 400000;
    options.stream.head = options.stream.idle_body = std::chrono::hours(1);
    restart(options);
    RawConnection other(port, 0, "127.0.0.2");
    ASSERT_TRUE(other.send("POST /read HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhe"));
    std::vector<std::unique_ptr<RawConnection>> crowd;
    for (int i = 0; i < 40; ++i) {
        crowd.push_back(std::make_unique<RawConnection>(port));
        ASSERT_TRUE(crowd.back()->send("GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(30000, 'a')));
    }
    EXPECT_TRUE(comes_to_pass([](const auto& load) { return load.connections <= 14; }));
    ASSERT_TRUE(other.send("llo"));
    EXPECT_EQ(other.read().value().body, "hello") << "who holds little stays";
}

TEST_F(Guarded, EndsTheWaitOfAClientThatHangsUp)
{
    RawConnection connection(port);
    ASSERT_TRUE(connection.send("GET /wait HTTP/1.1\r\nHost: a\r\n\r\n"));
    began.get_future().wait();
    connection.hang_up();
    EXPECT_EQ(ended.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
}

TEST_F(Guarded, StopEndsWaitsAndAnswersThem)
{
    RawConnection connection(port);
    ASSERT_TRUE(connection.send("GET /wait HTTP/1.1\r\nHost: a\r\n\r\n"));
    began.get_future().wait();
    server_->stop();
    const auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200);
    EXPECT_THROW(RawConnection{port}, std::runtime_error);
}

TEST_F(Guarded, StopAnswersWhatHasComeAndIsUnderWay)
{
    GuardOptions options;
    options.drain = std::chrono::minutes(5);
    restart(options);
    RawConnection connection(port);
    ASSERT_TRUE(connection.send("GET /big HTTP/1.1\r\nHost: a\r\n\r\n"));
    ASSERT_TRUE(connection.read_head()); // its body is on the way
    ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    auto stopped = std::async(std::launch::async, [this] { server_->stop(); });
    EXPECT_EQ(connection.read_bytes(kBig), kBig);
    const auto second = connection.read();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->body, "ok");
    EXPECT_EQ(second->header("connection"), "close");
    stopped.wait();
}

TEST_F(Guarded, StopWaitsForASlowReaderNoLongerThanItsDrain)
{
    GuardOptions options;
    options.drain = milliseconds(100);
    options.stream.idle_write = std::chrono::hours(1);
    restart(options);
    RawConnection slow(port, 4096);
    ASSERT_TRUE(slow.send("GET /big HTTP/1.1\r\nHost: a\r\n\r\n"));
    ASSERT_TRUE(slow.read_head());
    RawConnection silent(port); // a header that does not come
    ASSERT_TRUE(silent.send("GET / HTTP/1.1\r\n"));
    auto stopped = std::async(std::launch::async, [this] { server_->stop(); });
    EXPECT_EQ(stopped.wait_for(std::chrono::seconds(4)), std::future_status::ready);
    slow.hang_up();
}

TEST_F(Guarded, SaysWhenItCannotListenAnyMore)
{
    std::promise<void> told;
    GuardOptions options;
    options.on_deaf = [&told] { told.set_value(); };
    restart(options);
    EXPECT_TRUE(server_->listening());
    RawConnection connection(port);
    ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    ASSERT_TRUE(connection.read());
    ::shutdown(test_support::listening_sockets().at(port), SHUT_RDWR);
    ASSERT_EQ(told.get_future().wait_for(std::chrono::seconds(30)), std::future_status::ready);
    EXPECT_FALSE(server_->listening());
    server_->stop();
}

TEST_F(Guarded, SaysNothingOfDeafnessWhenItIsStopped)
{
    bool told = false;
    GuardOptions options;
    options.on_deaf = [&told] { told = true; };
    restart(options);
    server_->stop();
    EXPECT_FALSE(told);
    EXPECT_FALSE(server_->listening());
}

TEST_F(Guarded, AcceptsAgainAfterItHadNoDescriptors)
{
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
    RawConnection connection;
    // No number below the limit is free, whatever else opens a file meanwhile: malloc does for a new thread.
    const rlimit none_more{3, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none_more), 0);
    connection.connect(port);
    std::this_thread::sleep_for(milliseconds(100));
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    ASSERT_TRUE(connection.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n"));
    const auto answer = connection.read();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->body, "ok");
    EXPECT_TRUE(server_->listening());
}

TEST_F(Guarded, RefusesAPortThatIsTaken)
{
    GuardedServer second(
        {}, log_, [](const httplib::Request&, httplib::Response&, const httplib::ContentReader*) {});
    try {
        second.start("127.0.0.1", port);
        FAIL() << "two servers on one port";
    } catch (const std::system_error& error) {
        EXPECT_NE(std::string(error.what()).find("127.0.0.1 port " + std::to_string(port)), std::string::npos)
            << error.what();
    }
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
