// DefaultFloatingPoint: IEEE arithmetic for a scope: rounding to nearest, subnormal numbers kept, no traps.
//
// Why      a library that the caller also loads may have set flush-to-zero in a thread; a mesh of subnormal
//          size would collapse there and the same job give other bits.
// Threads  the mode belongs to a thread: each one that computes holds its own.
// Cost     tens of nanoseconds: once a call, never once a ray.
#pragma once

#include <cfenv>

namespace renderer {

class DefaultFloatingPoint {
public:
    DefaultFloatingPoint()
    {
        std::fegetenv(&before_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloatingPoint() { std::fesetenv(&before_); }
    DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
    DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

private:
    std::fenv_t before_;
};

} // namespace renderer
