#include "server/jobs/deadline.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <utility>

namespace server {

Deadline::Deadline(std::optional<double> seconds, std::function<void()> expire)
{
    if (!seconds) return;
    constexpr double kLongest = 1e8; // three years: the clock's own range is not left
    const auto span = std::chrono::duration<double>(std::min(*seconds, kLongest));
    const auto when = std::chrono::steady_clock::now() +
                      std::chrono::duration_cast<std::chrono::steady_clock::duration>(span);
    timer_ = std::jthread([when, expire = std::move(expire)](const std::stop_token& stop) {
        std::mutex mutex;
        std::condition_variable_any change;
        std::unique_lock lock(mutex);
        change.wait_until(lock, stop, when, [] { return false; });
        if (!stop.stop_requested()) expire();
    });
}

} // namespace server
