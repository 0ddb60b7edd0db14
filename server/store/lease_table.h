// LeaseTable: who holds which job until when, in memory: every lease is void at a start, and clocks that jump
// cannot matter.
//
// Threads  any.
#pragma once

#include "server/store/store.h"

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

namespace server {

class LeaseTable {
public:
    using Time = std::chrono::steady_clock::time_point;

    void grant(const std::vector<Lease>& leases, Time until);
    // Those that are still held get the new time. How many they are.
    std::size_t renew(const std::vector<Lease>& leases, Time until);
    // Held no more; a lease that was granted since under a higher epoch stays.
    void forget(const std::vector<Lease>& leases);
    std::vector<Lease> lapsed(Time now) const;
    // How long until the first of them lapses, `limit` at most, rounded up.
    std::chrono::milliseconds until_lapse(Time now, std::chrono::milliseconds limit) const;

private:
    struct Held {
        Lease lease;
        Time until;
    };
    mutable std::mutex mutex_;
    std::map<JobId, Held> held_; // as many as there are workers
};

} // namespace server
