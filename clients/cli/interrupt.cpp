#include "clients/cli/interrupt.h"

#include "clients/cli/exit_code.h"

#include <unistd.h>

namespace clients {
namespace {

// Sent to the waiting thread alone, to end it.
constexpr int kEnd = SIGUSR1;

void wait_for_signals(const std::stop_token& done, const std::stop_source& stop, const sigset_t& signals)
{
    for (int signal = 0; ::sigwait(&signals, &signal) == 0;) {
        if (signal == kEnd) {
            if (done.stop_requested()) return;
        } else if (!stop.request_stop()) {
            ::_exit(static_cast<int>(ExitCode::interrupted));
        }
    }
}

} // namespace

Interrupt::Interrupt()
{
    sigset_t signals;
    ::sigemptyset(&signals);
    ::sigaddset(&signals, SIGINT);
    ::sigaddset(&signals, SIGTERM);
    ::sigaddset(&signals, kEnd);
    sigset_t blocked = signals;
    ::sigaddset(&blocked,
                SIGPIPE); // a service that hangs up is an error to report, not the end of the process
    ::pthread_sigmask(SIG_BLOCK, &blocked, &previous_);
    waiter_ = std::jthread(
        [stop = stop_, signals](const std::stop_token& done) { wait_for_signals(done, stop, signals); });
}

Interrupt::~Interrupt()
{
    waiter_.request_stop();
    ::pthread_kill(waiter_.native_handle(), kEnd);
    waiter_.join();
    ::pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
}

} // namespace clients
