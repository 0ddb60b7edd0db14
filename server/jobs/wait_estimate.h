// WaitEstimate: how long a new job would wait, from how long the last ones took.
//
// Threads  every function may be called from any thread.
#pragma once

#include <cstdint>
#include <mutex>

namespace server {

class WaitEstimate {
public:
    void took(double seconds);
    // Whole seconds, 1 to 3600, until a job behind `ahead` others likely starts.
    int seconds(std::uint64_t ahead) const;

private:
    mutable std::mutex mutex_;
    double mean_s_ = 1; // weighted towards the last few jobs; a guess until the first
    bool measured_ = false;
};

} // namespace server
