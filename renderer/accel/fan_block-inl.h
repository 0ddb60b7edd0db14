// FanBlock: four triangles as the apex of a fan sees them. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_FAN_BLOCK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_FAN_BLOCK_INL
#undef HELIOGRAPH_FAN_BLOCK_INL
#else
#define HELIOGRAPH_FAN_BLOCK_INL
#endif

#include "renderer/accel/prepare_fan-inl.h"

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// With d = (slope_x, slope_y, 1): the ray passes within edge k where dot(edge[k], d) >= 0, and meets the plane at
// depth volume / dot(whole, d). What is computed from this in float is off by less than the errors told here;
// they also hold for what the double test computes.
struct FanBlock {
    static constexpr unsigned kLanes = TriangleBlock::kLanes;
    alignas(32) float edge[3][3][kLanes]; // [edge][axis][triangle]
    alignas(32) float whole[3][kLanes];
    alignas(32) float edge_error[kLanes], whole_error[kLanes];
    alignas(32) float least_volume[kLanes],
        most_volume[kLanes];                             // certain bounds, positive where `faces` has a bit
    alignas(32) float nearest[kLanes], farthest[kLanes]; // depths of the corners
    // The slopes of rays that may meet it are between these; infinite where a corner is not clearly beyond the apex.
    alignas(32) float least_x[kLanes], most_x[kLanes], least_y[kLanes], most_y[kLanes];
    unsigned faces =
        0; // bit i: which side of triangle i the apex sees is certain; it counts as the inner one
};

// Errors. The corners from the apex, their differences and all products are computed in double: relative errors of
// a few 2^-53 of A = the farthest corner, and of what the double test computes from the rays' own origins, up to
// `reach` farther: at most 2^-47 (A + reach)^2 in an edge function. Rounding a vector n to float, the slopes
// (3 roundings, at most kSteepest), and the two products and sums make less than 16 * 2^-24 |n|_1 together, also
// where it is the corner of a group's bounds that is asked. Lines that pass `aside` from the apex shift edge
// functions by less than 4 * aside * |edge|_1. Slopes of corners have five roundings in float, those of rays three.
HWY_INLINE void
see_block(const RayFan& fan, const TriangleBlock& block, FanBlock& out) // NOLINT(readability-function-size)
{
    const hn::CappedTag<double, TriangleBlock::kLanes> d;
    const hn::Rebind<float, decltype(d)> f;
    using V = hn::Vec<decltype(d)>;
    out.faces = 0;
    const std::size_t axes[3] = {fan.x, fan.y, fan.z};
    const auto aside = hn::Set(d, 4.0 * static_cast<double>(fan.aside));
    const auto reach = hn::Set(d, static_cast<double>(fan.reach));
    for (std::size_t lane = 0; lane < TriangleBlock::kLanes; lane += hn::MaxLanes(d)) {
        V corner[3][3], along[3][3]; // from the apex; from the corner to the next
        auto farthest = reach, longest = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool turn = axis == 2 && fan.turned;
            const auto apex = hn::Set(d, fan.apex[axis]);
            V at[3];
            auto span = hn::Zero(d);
            for (std::size_t k = 0; k < 3; ++k) {
                at[k] = hn::PromoteTo(d, hn::Load(f, block.corners[k][axes[axis]] + lane));
                corner[k][axis] = turn ? hn::Sub(apex, at[k]) : hn::Sub(at[k], apex);
                span = hn::Max(span, hn::Abs(corner[k][axis]));
            }
            farthest = hn::Max(farthest, span);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t next = k == 2 ? 0 : k + 1;
                along[k][axis] = turn ? hn::Sub(at[k], at[next]) : hn::Sub(at[next], at[k]);
                longest = hn::Max(longest, hn::Abs(along[k][axis]));
            }
        }
        farthest = hn::Add(farthest, reach);
        const auto cross = [&](const V(&a)[3], const V(&b)[3], std::size_t axis) HWY_ATTR {
            const std::size_t i = axis == 2 ? 0 : axis + 1, j = i == 2 ? 0 : i + 1;
            return hn::MulSub(a[i], b[j], hn::Mul(a[j], b[i]));
        };
        const auto sum_of_sizes = [&](const V(&v)[3]) HWY_ATTR {
            return hn::Add(hn::Abs(v[0]), hn::Add(hn::Abs(v[1]), hn::Abs(v[2])));
        };
        V whole[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            whole[axis] = cross(along[0], along[1], axis);
        const auto volume = hn::MulAdd(
            whole[0], corner[0][0], hn::MulAdd(whole[1], corner[0][1], hn::Mul(whole[2], corner[0][2])));
        const auto flip = hn::CopySign(hn::Zero(d), volume);
        const auto size = hn::Abs(volume), whole_size = sum_of_sizes(whole);
        const auto squared = hn::Mul(farthest, farthest), unit = hn::Set(d, 0x1p-20);
        const auto volume_error = hn::MulAdd(
            size,
            hn::Set(d, 0x1p-22),
            hn::MulAdd(whole_size, aside, hn::Mul(hn::Mul(longest, hn::Set(d, 0x1p-40)), squared)));
        out.faces |= bits_of(d, hn::Gt(size, volume_error)) << lane;
        const auto store = [&](V value, float* to)
                               HWY_ATTR { hn::Store(hn::DemoteTo(f, value), f, to + lane); };
        store(hn::Sub(size, volume_error), out.least_volume);
        store(hn::Add(size, volume_error), out.most_volume);
        store(hn::MulAdd(whole_size, unit, hn::Mul(hn::Mul(longest, longest), hn::Set(d, 0x1p-46))),
              out.whole_error);
        auto largest = hn::Zero(d);
        for (std::size_t k = 0; k < 3; ++k) {
            V edge[3];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                edge[axis] = cross(corner[k], along[k], axis);
                store(hn::Xor(edge[axis], flip), out.edge[k][axis]);
            }
            largest = hn::Max(largest, sum_of_sizes(edge));
        }
        store(hn::Add(hn::MulAdd(largest, unit, hn::Mul(squared, hn::Set(d, 0x1p-44))),
                      hn::MulAdd(longest, hn::Mul(aside, hn::Set(d, 4.0)), hn::Set(d, 0x1p-110))),
              out.edge_error);
        for (std::size_t axis = 0; axis < 3; ++axis)
            store(hn::Xor(whole[axis], flip), out.whole[axis]);
        const auto nearest = hn::Min(corner[0][2], hn::Min(corner[1][2], corner[2][2]));
        store(nearest, out.nearest);
        store(hn::Max(corner[0][2], hn::Max(corner[1][2], corner[2][2])), out.farthest);

        const auto clear = hn::Lt(hn::MulAdd(farthest, hn::Set(d, 0x1p-20), aside), nearest);
        const auto infinity = hn::Set(f, std::numeric_limits<float>::infinity());
        // Of what is not clearly beyond the apex: a blur without end.
        const auto blur =
            hn::IfThenElse(hn::Gt(hn::DemoteTo(f, hn::IfThenElseZero(clear, nearest)), hn::Zero(f)),
                           hn::Div(hn::DemoteTo(f, aside), hn::DemoteTo(f, nearest)),
                           infinity);
        hn::Vec<decltype(f)> depth[3];
        for (std::size_t k = 0; k < 3; ++k)
            depth[k] = hn::DemoteTo(f, corner[k][2]);
        const auto bound_slopes = [&](std::size_t axis, float* least, float* most) HWY_ATTR {
            const auto slope = [&](std::size_t k)
                                   HWY_ATTR { return hn::Div(hn::DemoteTo(f, corner[k][axis]), depth[k]); };
            const auto a = slope(0), b = slope(1), c = slope(2);
            const auto lower = hn::Min(a, hn::Min(b, c)), upper = hn::Max(a, hn::Max(b, c));
            const auto slack =
                hn::MulAdd(hn::Max(hn::Abs(lower), hn::Abs(upper)), hn::Set(f, 0x1p-20f), blur);
            hn::Store(hn::Sub(lower, slack), f, least + lane);
            hn::Store(hn::Add(upper, slack), f, most + lane);
        };
        bound_slopes(0, out.least_x, out.most_x);
        bound_slopes(1, out.least_y, out.most_y);
    }
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
