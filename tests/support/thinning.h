// kThinning: of what a test repeats very often, a sanitizer's build does a part. kSlowness: what else takes it so many times
// as long at most.
#pragma once

namespace tests {

#ifdef HELIOGRAPH_SANITIZED
inline constexpr int kThinning = 20, kSlowness = 10;
#else
inline constexpr int kThinning = 1, kSlowness = 1;
#endif

} // namespace tests
