// Clocks: time on the wall, and time that a thread or the process spent on a processor. The latter does not
// count what others do on the same machine, but for the caches and memory that they take part in.
#pragma once

#include <chrono>
#include <ctime>

namespace bench {

// Units  seconds.
struct Spent {
    double wall_s = 0, cpu_s = 0;
};

inline double read_clock(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// From its making on: CLOCK_THREAD_CPUTIME_ID counts the calling thread, CLOCK_PROCESS_CPUTIME_ID all of them.
class Stopwatch {
public:
    explicit Stopwatch(clockid_t processor_clock) : clock_(processor_clock) {}

    Spent spent() const { return {read_clock(CLOCK_MONOTONIC) - wall_, read_clock(clock_) - cpu_}; }

private:
    clockid_t clock_;
    double wall_ = read_clock(CLOCK_MONOTONIC), cpu_ = read_clock(clock_);
};

} // namespace bench
