#include "server/app/stop_signals.h"

#include <gtest/gtest.h>

#include <csignal>
#include <unistd.h>

namespace {

// In a process of its own: the first signal is waited for, the second ends the process where it stands.
[[noreturn]] void receive(int first, int second)
{
    const server::StopSignals signals;
    kill(getpid(), first);
    if (signals.wait() != first) _exit(1);
    signals.leave_on_next();
    kill(getpid(), second);
    for (;;)
        pause(); // an orderly stop that takes for ever
}

TEST(StopSignalsDeathTest, ASecondSignalEndsTheProcessAtOnce)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(receive(SIGTERM, SIGINT), testing::ExitedWithCode(128 + SIGINT), "");
    EXPECT_EXIT(receive(SIGINT, SIGTERM), testing::ExitedWithCode(128 + SIGTERM), "");
}

} // namespace
