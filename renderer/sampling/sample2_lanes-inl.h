// Pairs of random numbers taken as many at a time as a vector of doubles holds. Included once a target of Highway.
#if defined(HELIOGRAPH_SAMPLE2_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_SAMPLE2_LANES_INL
#undef HELIOGRAPH_SAMPLE2_LANES_INL
#else
#define HELIOGRAPH_SAMPLE2_LANES_INL
#endif

#include "renderer/sampling/sampler.h"

#include <algorithm>
#include <cstddef>
#include <hwy/highway.h>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Calls draw(first, count, u0, u1) for u[first] and the `count` from there on; the last of them fills what is left of the
// vectors.
template <class D, class Draw>
HWY_INLINE void for_lanes_of(D d, std::span<const Sample2> u, Draw&& draw)
{
    constexpr std::size_t kLanes = hn::MaxLanes(D());
    alignas(64) double u0[kLanes], u1[kLanes];
    for (std::size_t first = 0; first < u.size(); first += kLanes) {
        const std::size_t count = std::min(kLanes, u.size() - first);
        for (std::size_t i = 0; i < kLanes; ++i) {
            const Sample2& numbers = u[first + std::min(i, count - 1)];
            u0[i] = static_cast<double>(numbers.u0);
            u1[i] = static_cast<double>(numbers.u1);
        }
        draw(first, count, hn::Load(d, u0), hn::Load(d, u1));
    }
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
