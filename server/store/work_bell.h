// WorkBell: rings when work comes, for Store::wait_work.
//
// Threads  any. A ring between mark() and wait() is not missed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>

namespace server {

class WorkBell {
public:
    // Take the mark, look whether there is work, then wait for a ring after the mark.
    std::uint64_t mark() const;
    void ring();
    void wait(std::uint64_t mark, std::chrono::milliseconds timeout, std::stop_token stop);

private:
    mutable std::mutex mutex_;
    std::condition_variable_any rung_;
    std::uint64_t rings_ = 0;
};

} // namespace server
