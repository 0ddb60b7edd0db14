#include "tests/server/http/guard/guarded.h"
#include "tests/support/listening_sockets.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/socket.h>
#include <system_error>
#include <thread>

namespace {

using server::GuardedServer;
using server::GuardOptions;
using std::chrono::milliseconds;
using test_support::RawConnection;
using tests::Guarded;
using tests::kBig;

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

} // namespace
