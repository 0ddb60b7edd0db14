#include "tests/server/http/guard/guarded.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using server::GuardOptions;
using std::chrono::milliseconds;
using test_support::RawConnection;
using tests::Guarded;
using tests::kBig;
using tests::kLargeHead;
using tests::kLargeStart;

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

} // namespace
