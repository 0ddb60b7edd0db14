#include "server/store/lease_table.h"

#include <algorithm>

namespace server {

void LeaseTable::grant(const std::vector<Lease>& leases, Time until)
{
    const std::lock_guard lock(mutex_);
    for (const Lease& lease : leases)
        held_[lease.job] = {lease, until};
}

std::size_t LeaseTable::renew(const std::vector<Lease>& leases, Time until)
{
    const std::lock_guard lock(mutex_);
    std::size_t renewed = 0;
    for (const Lease& lease : leases) {
        const auto held = held_.find(lease.job);
        if (held == held_.end() || held->second.lease.epoch != lease.epoch) continue;
        held->second.until = until;
        ++renewed;
    }
    return renewed;
}

void LeaseTable::forget(const std::vector<Lease>& leases)
{
    const std::lock_guard lock(mutex_);
    for (const Lease& lease : leases) {
        const auto held = held_.find(lease.job);
        if (held != held_.end() && held->second.lease.epoch <= lease.epoch) held_.erase(held);
    }
}

std::vector<Lease> LeaseTable::lapsed(Time now) const
{
    const std::lock_guard lock(mutex_);
    std::vector<Lease> leases;
    for (const auto& [job, held] : held_)
        if (held.until <= now) leases.push_back(held.lease);
    return leases;
}

std::chrono::milliseconds LeaseTable::until_lapse(Time now, std::chrono::milliseconds limit) const
{
    const std::lock_guard lock(mutex_);
    limit = std::max(limit, std::chrono::milliseconds::zero());
    for (const auto& [job, held] : held_) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(held.until - now);
        limit = std::clamp(left, std::chrono::milliseconds::zero(), limit);
    }
    return limit;
}

} // namespace server
