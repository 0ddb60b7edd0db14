// Interrupt: Ctrl-C and SIGTERM as a stop token instead of a dead process.
//
// Threads  must be made in main before any other thread, which then all leave the signals to it. The first
//          signal requests the stop; a second one ends the process at once.
#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace clients {

class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    std::stop_token token() const { return stop_.get_token(); }

private:
    std::stop_source stop_;
    sigset_t previous_{};
    std::jthread waiter_;
};

} // namespace clients
