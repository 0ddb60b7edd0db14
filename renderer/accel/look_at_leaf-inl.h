// look_at_leaf: a ray and the triangles of a leaf in float: which the double test would reject, which it would accept, and
// where. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_LOOK_AT_LEAF_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_LOOK_AT_LEAF_INL
#undef HELIOGRAPH_LOOK_AT_LEAF_INL
#else
#define HELIOGRAPH_LOOK_AT_LEAF_INL
#endif

#include "renderer/accel/kernel_lanes-inl.h"
#include "renderer/accel/lone_rays.h"

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// What the quick look at the triangles of a leaf tells: which lanes the double test might accept up to `end`, and
// which it accepts for certain; where their t lies.
struct Look {
    static constexpr unsigned kLanes = 2 * TriangleBlock::kLanes;
    alignas(32) float least[kLanes], most[kLanes];
    unsigned may, sure;
};

// Corners of a leaf's blocks, both at once where vectors are wide enough.
#if HWY_MAX_BYTES >= 32
using LeafLanes = hn::CappedTag<float, Look::kLanes>;
#else
using LeafLanes = Four;
#endif
HWY_INLINE hn::Vec<LeafLanes>
corners_of(const TriangleBlock* const (&blocks)[2], std::size_t k, std::size_t axis_bytes, std::size_t lane)
{
    const LeafLanes d;
    const auto at = [&](std::size_t i) HWY_ATTR {
        const auto* const bytes = reinterpret_cast<const char*>(blocks[i]->corners[k]) + axis_bytes;
        return reinterpret_cast<const float*>(bytes);
    };
#if HWY_MAX_BYTES >= 32
    static_cast<void>(lane);
    const hn::Half<LeafLanes> half;
    return hn::Combine(d, hn::Load(half, at(1)), hn::Load(half, at(0)));
#else
    return hn::Load(d, at(lane / TriangleBlock::kLanes) + lane % TriangleBlock::kLanes);
#endif
}

// The double test's places across the ray are within `lateral` of these, so an edge value is within `slack` of its
// counterpart: only when two edges disagree beyond that is the triangle certainly missed, and only when all
// agree beyond it is it certainly met. Along the ray a hit lies between the corners' depths, and where edge
// values tell the corners' weights, near their weighted mean. A NaN neither rejects nor assures.
HWY_INLINE void
look_at_leaf(const LoneRays& run, unsigned ray, const TriangleBlock* const (&blocks)[2], Look& look)
{
    const LeafLanes d;
    const LoneRays::Axes axes = run.axes[ray];
    const auto set = [&](const LoneRays::Lanes<float>& lanes) HWY_ATTR { return hn::Set(d, lanes[ray]); };
    const auto from_x = set(run.from_x), from_y = set(run.from_y), from_z = set(run.from_z);
    const auto shear_x = set(run.shear_x), shear_y = set(run.shear_y), depth_scale = set(run.depth_scale);
    const auto near_side = set(run.near_lateral), end = set(run.end);
    unsigned may_hit = 0, sure_hit = 0;
    for (std::size_t lane = 0; lane < Look::kLanes; lane += hn::MaxLanes(d)) {
        hn::Vec<LeafLanes> x[3], y[3], t[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto depth = hn::Sub(corners_of(blocks, k, axes.z, lane), from_z);
            x[k] = hn::NegMulAdd(shear_x, depth, hn::Sub(corners_of(blocks, k, axes.x, lane), from_x));
            y[k] = hn::NegMulAdd(shear_y, depth, hn::Sub(corners_of(blocks, k, axes.y, lane), from_y));
            t[k] = hn::Mul(depth, depth_scale);
        }
        const auto edge = [&](std::size_t p, std::size_t q)
                              HWY_ATTR { return hn::MulSub(x[q], y[p], hn::Mul(y[q], x[p])); };
        const auto e0 = edge(1, 2), e1 = edge(2, 0), e2 = edge(0, 1);
        const auto reach = [&](std::size_t k) HWY_ATTR { return hn::Add(hn::Abs(x[k]), hn::Abs(y[k])); };
        const auto widest = hn::Max(reach(0), hn::Max(reach(1), reach(2)));
        const auto first = hn::Min(t[0], hn::Min(t[1], t[2])), last = hn::Max(t[0], hn::Max(t[1], t[2]));
        const auto distance = hn::Max(hn::Abs(first), hn::Abs(last));
        // What rounding comes to at the sizes that occur here.
        const auto side = hn::MulAdd(hn::Set(d, 0x1p-21f), hn::Max(widest, distance), near_side);
        const auto slack = hn::Mul(hn::Mul(side, hn::Set(d, 4.0f)), hn::Add(widest, side));
        const auto low = hn::Min(e0, hn::Min(e1, e2)), high = hn::Max(e0, hn::Max(e1, e2));
        const auto minus = hn::Neg(slack);
        const auto beside = hn::And(hn::Lt(low, minus), hn::Lt(slack, high));
        const auto outside = hn::Or(beside, hn::Or(hn::Lt(end, first), hn::Lt(last, set(run.begin))));
        const unsigned may = ~bits_of(d, outside) & ((1u << hn::MaxLanes(d)) - 1);
        const auto margin = hn::Mul(side, hn::Set(d, 6.0f));
        const auto within = hn::Or(hn::Lt(slack, low), hn::Lt(high, minus));
        const auto sure = hn::And(within, hn::And(hn::Lt(margin, first), hn::Lt(last, set(run.limit))));
        // The weights are within 9 slack / (|sum| - 3 slack) of the double test's, together.
        const auto sum = hn::Add(e0, hn::Add(e1, e2));
        const auto weight = hn::Div(hn::Set(d, 1.0f), sum);
        const auto mean =
            hn::MulAdd(hn::Mul(e0, weight),
                       t[0],
                       hn::MulAdd(hn::Mul(e1, weight), t[1], hn::Mul(hn::Mul(e2, weight), t[2])));
        const auto off =
            hn::Div(hn::Mul(hn::Mul(slack, hn::Set(d, 9.0f)), hn::Sub(last, first)),
                    hn::Max(hn::Sub(hn::Abs(sum), hn::Mul(slack, hn::Set(d, 3.0f))), hn::Zero(d)));
        const auto about = hn::Add(off, margin);
        const auto behind = hn::And(within, hn::Lt(hn::Add(mean, about), hn::Zero(d)));
        const unsigned ahead = may & ~bits_of(d, behind);
        may_hit |= ahead << lane;
        sure_hit |= bits_of(d, sure) << lane;
        hn::Store(hn::IfThenElse(within, hn::Max(first, hn::Sub(mean, about)), first), d, look.least + lane);
        hn::Store(hn::Min(hn::Add(last, margin), hn::Add(mean, about)), d, look.most + lane);
    }
    look.may = may_hit;
    look.sure = sure_hit;
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
