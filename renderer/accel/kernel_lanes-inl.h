// What all kernels share: masks as bits, the children of a node, and the quick look at a triangle. Included by
// mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_KERNEL_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_KERNEL_LANES_INL
#undef HELIOGRAPH_KERNEL_LANES_INL
#else
#define HELIOGRAPH_KERNEL_LANES_INL
#endif

#include "renderer/accel/ray_run.h"
#include "renderer/accel/triangle_block.h"
#include "renderer/accel/wide_bvh.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Eight = hn::CappedTag<float, WideNode::kChildren>;
using Four = hn::CappedTag<float, TriangleBlock::kLanes>;

template <class D>
HWY_INLINE unsigned bits_of(D d, hn::Mask<D> mask)
{
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return (bits[0] | unsigned{bits[1]} << 8) & ((1u << hn::MaxLanes(d)) - 1);
}

// What can wait at most: a level leaves all but one child behind.
inline constexpr unsigned kMostWaiting = (WideNode::kChildren - 1) * kMaxBvhDepth + 1;

// The children whose boxes the ray may enter before `end`: where, and which.
struct Entered {
    alignas(64) float entries[WideNode::kChildren];
    unsigned children;
};

// Where the double test rejects for certain. x, y, t: the corners across and along the ray, from its float copy.
// Their places across are within `side` of where the double test has them, so an edge value is within `slack`
// of its counterpart; only when two edges disagree beyond that is the triangle certainly missed. Along the ray
// a hit lies between the corners' depths. A NaN rejects nothing.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D>
certain_miss(D d, const V (&x)[3], const V (&y)[3], const V (&t)[3], V side, V begin, V end)
{
    const auto edge = [&](std::size_t p, std::size_t q)
                          HWY_ATTR { return hn::MulSub(x[q], y[p], hn::Mul(y[q], x[p])); };
    const auto e0 = edge(1, 2), e1 = edge(2, 0), e2 = edge(0, 1);
    const auto reach = [&](std::size_t k) HWY_ATTR { return hn::Add(hn::Abs(x[k]), hn::Abs(y[k])); };
    const auto widest = hn::Max(reach(0), hn::Max(reach(1), reach(2)));
    const auto slack = hn::Mul(hn::Mul(side, hn::Set(d, 4.0f)), hn::Add(widest, side));
    const auto least = hn::Min(e0, hn::Min(e1, e2)), most = hn::Max(e0, hn::Max(e1, e2));
    const auto beside = hn::And(hn::Lt(least, hn::Neg(slack)), hn::Lt(slack, most));
    const auto beyond = hn::Lt(end, hn::Min(t[0], hn::Min(t[1], t[2])));
    const auto behind = hn::Lt(hn::Max(t[0], hn::Max(t[1], t[2])), begin);
    return hn::Or(beside, hn::Or(beyond, behind));
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
