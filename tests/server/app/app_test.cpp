#include "server/app/app.h"
#include "tests/support/listening_sockets.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <sstream>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace {

// In a process of its own: serves, and loses both listening sockets as soon as they are there.
[[noreturn]] void serve_and_go_deaf(const std::string& data)
{
    const server::StopSignals signals;
    std::thread([] {
        for (;;)
            if (const auto sockets = test_support::listening_sockets(); sockets.size() == 2) {
                for (const auto& [port, fd] : sockets)
                    ::shutdown(fd, SHUT_RDWR);
                return;
            }
    }).detach();
    server::ServiceOptions options;
    options.port = 0;
    options.health_port = 0;
    options.data = data;
    std::ostringstream out;
    _exit(server::run_service(options, signals, out));
}

TEST(RunServiceDeathTest, EndsWithAnErrorWhenNobodyCanReachItAnyMore)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const tests::TempFolder folder;
    EXPECT_EXIT(
        serve_and_go_deaf(folder.file("data")), testing::ExitedWithCode(1), "listener_broken.*\"deaf\":true");
}

} // namespace
