// kThinning: of what a test repeats very often, a sanitizer's build does a part.
#pragma once

namespace tests {

#ifdef HELIOGRAPH_SANITIZED
inline constexpr int kThinning = 20;
#else
inline constexpr int kThinning = 1;
#endif

} // namespace tests
