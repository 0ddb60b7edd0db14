#include "server/http/guard/listener.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <system_error>

namespace {

using server::AcceptError;
using server::kind_of_accept_error;
using server::Listener;

TEST(Listener, GoesOnAfterWhatConcernsOneConnection)
{
    for (const int error : {ECONNABORTED, EINTR, EPROTO, EPERM, ENETDOWN, EHOSTUNREACH, ETIMEDOUT})
        EXPECT_EQ(kind_of_accept_error(error), AcceptError::of_one) << error;
}

TEST(Listener, WaitsWhileSomethingIsShort)
{
    for (const int error : {EMFILE, ENFILE, ENOBUFS, ENOMEM})
        EXPECT_EQ(kind_of_accept_error(error), AcceptError::shortage) << error;
}

TEST(Listener, EndsWhenItsSocketIsNone)
{
    for (const int error : {EBADF, EINVAL, ENOTSOCK, EFAULT})
        EXPECT_EQ(kind_of_accept_error(error), AcceptError::broken) << error;
}

TEST(Listener, NamesHostAndPortWhenItCannotListen)
{
    const server::Log log(server::LogLevel::error);
    const auto refusal = [&](const std::string& host, int port) -> std::string {
        try {
            const Listener listener(host, port, log);
            return "it listens";
        } catch (const std::system_error& error) {
            return error.what();
        }
    };
    EXPECT_EQ(refusal("203.0.113.1", 4711).find("cannot listen on 203.0.113.1 port 4711: "), 0u);
    EXPECT_EQ(refusal("no such host", 4711).find("cannot listen on no such host port 4711: "), 0u);
    const Listener first("127.0.0.1", 0, log);
    EXPECT_GT(first.port(), 0);
    EXPECT_EQ(refusal("127.0.0.1", first.port()).find("cannot listen on 127.0.0.1 port "), 0u);
}

} // namespace
