// WaitEstimate: how soon a full queue has a place again, from how long the last jobs took.
//
// Threads  every function may be called from any thread.
#pragma once

#include <mutex>

namespace server {

class WaitEstimate {
public:
    void took(double seconds);
    // Whole seconds, 1 to 30, until ONE place is likely free: jobs run one after another, each on all threads,
    // so that is what a single job takes, however many wait. Who asks too early loses nothing but a request.
    int seconds() const;

private:
    mutable std::mutex mutex_;
    double mean_s_ = 1; // weighted towards the last few jobs; a guess until the first
    bool measured_ = false;
};

} // namespace server
