// StopSignals: SIGTERM and SIGINT as something to wait for, and SIGPIPE as nothing.
//
// Threads  make it before any other thread: threads inherit that the signals are blocked.
#pragma once

#include <csignal>

namespace server {

class StopSignals {
public:
    StopSignals();

    int wait() const;           // the signal that came
    void raise() const;         // as if a SIGTERM had come; from any thread
    void leave_on_next() const; // from now on a signal ends the process at once, with 128 + its number

private:
    sigset_t set_{};
};

} // namespace server
