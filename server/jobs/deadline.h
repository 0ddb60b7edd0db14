// Deadline: does something once when time is up, unless it is destroyed first.
#pragma once

#include <functional>
#include <optional>
#include <thread>

namespace server {

class Deadline {
public:
    // Nothing: no deadline, no thread. `expire` is called from a thread of its own.
    Deadline(std::optional<double> seconds, std::function<void()> expire);

private:
    std::jthread timer_;
};

} // namespace server
