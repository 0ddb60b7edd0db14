#include "server/store/work_bell.h"

#include <utility>

namespace server {

std::uint64_t WorkBell::mark() const
{
    const std::lock_guard lock(mutex_);
    return rings_;
}

void WorkBell::ring()
{
    {
        const std::lock_guard lock(mutex_);
        ++rings_;
    }
    rung_.notify_all();
}

void WorkBell::wait(std::uint64_t mark, std::chrono::milliseconds timeout, std::stop_token stop)
{
    std::unique_lock lock(mutex_);
    rung_.wait_for(lock, std::move(stop), timeout, [&] { return rings_ != mark; });
}

} // namespace server
