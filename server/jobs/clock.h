// The wall clock as the store counts it.
#pragma once

#include <chrono>
#include <cstdint>

namespace server {

inline std::int64_t unix_ms()
{
    using std::chrono::system_clock;
    return std::chrono::duration_cast<std::chrono::milliseconds>(system_clock::now().time_since_epoch())
        .count();
}

} // namespace server
