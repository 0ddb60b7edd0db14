#include "server/jobs/wait_estimate.h"

#include <algorithm>
#include <cmath>

namespace server {

void WaitEstimate::took(double seconds)
{
    constexpr double kWeight = 0.2;
    const std::lock_guard lock(mutex_);
    mean_s_ = measured_ ? mean_s_ + kWeight * (seconds - mean_s_) : seconds;
    measured_ = true;
}

int WaitEstimate::seconds() const
{
    const std::lock_guard lock(mutex_);
    return static_cast<int>(std::clamp(std::ceil(mean_s_), 1.0, 30.0));
}

} // namespace server
