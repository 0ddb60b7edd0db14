#include "server/app/stop_signals.h"

#include <cerrno>
#include <pthread.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace server {

namespace {

int wait_for(const sigset_t& set)
{
    int signal = 0;
    const int error = sigwait(&set, &signal);
    if (error != 0) throw std::system_error(error, std::generic_category(), "sigwait");
    return signal;
}

} // namespace

StopSignals::StopSignals()
{
    sigemptyset(&set_);
    sigaddset(&set_, SIGTERM);
    sigaddset(&set_, SIGINT);
    const int error = pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    if (error != 0) throw std::system_error(error, std::generic_category(), "pthread_sigmask");
    // A client that hangs up is an error of its socket, not the end of the service.
    if (std::signal(SIGPIPE, SIG_IGN) == SIG_ERR)
        throw std::system_error(errno, std::generic_category(), "signal SIGPIPE");
}

int StopSignals::wait() const
{
    return wait_for(set_);
}

void StopSignals::raise() const
{
    kill(getpid(), SIGTERM);
}

void StopSignals::leave_on_next() const
{
    // Nothing may hold this up, so it is a thread that nobody joins; the process ends under it.
    std::thread([set = set_] { _exit(128 + wait_for(set)); }).detach();
}

} // namespace server
