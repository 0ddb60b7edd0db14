// FanLeaf: the triangles of a leaf as the apex of a fan sees them. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_FAN_LEAF_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_FAN_LEAF_INL
#undef HELIOGRAPH_FAN_LEAF_INL
#else
#define HELIOGRAPH_FAN_LEAF_INL
#endif

#include "renderer/accel/prepare_fan-inl.h"

#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// With d = (slope_x, slope_y, 1): a ray passes within edge k where dot(edge[k], d) >= 0, and meets the plane at depth
// volume / dot(whole, d). Both are told at their largest: they are less than what is computed, by less than the slack.
// That also holds for what the double test computes.
struct FanLeaf {
    static constexpr unsigned kLanes = 2 * TriangleBlock::kLanes;
    unsigned meeting = 0; // bit i: some ray may hit triangle i, and the rest is told of it
    unsigned faces = 0;   // bit i: which side of it the apex sees is certain; that counts as the inner one
    alignas(32) float edge[3][3][kLanes]; // [edge][axis][triangle]
    alignas(32) float whole[3][kLanes];
    alignas(32) float edge_slack[kLanes], whole_slack[kLanes];
    alignas(32) float least_volume[kLanes],
        most_volume[kLanes];                             // certain bounds, positive where it is a face
    alignas(32) float nearest[kLanes], farthest[kLanes]; // certain bounds of the corners' depths
    // The slopes of rays that may meet it are between these; infinite where a corner is not clearly beyond the apex.
    alignas(32) float least_x[kLanes], most_x[kLanes], least_y[kLanes], most_y[kLanes];
};

// The triangles of one or two blocks. kPrecise: planes and depths in double, for rays that start next to triangles.
template <bool kPrecise>
class LeafViewer {
public:
    HWY_INLINE LeafViewer(const RayFan& fan, float end) : fan_(fan), end_(end) {}

    HWY_INLINE void see(const TriangleBlock* blocks, unsigned count, FanLeaf& out) const
    {
        out.meeting = out.faces = 0;
        for (unsigned lane = 0; lane < count * TriangleBlock::kLanes; lane += kSeenAtOnce)
            see_lanes(blocks, count, lane, out);
    }

private:
    using D = Eight;
    using V = hn::Vec<D>;
    using M = hn::Mask<D>;
    static constexpr unsigned kSeenAtOnce = hn::MaxLanes(D());

    // The same member of both blocks side by side; of one block twice.
    template <class T>
    static HWY_INLINE hn::Vec<hn::Rebind<T, D>> load(const T* first, const T* second, unsigned lane)
    {
        const hn::Rebind<T, D> d;
#if HWY_TARGET != HWY_SCALAR // which has no halves
        if constexpr (kSeenAtOnce > TriangleBlock::kLanes) {
            const hn::Half<decltype(d)> half;
            return hn::Combine(d, hn::Load(half, second), hn::Load(half, first));
        }
#endif
        return hn::Load(
            d, lane < TriangleBlock::kLanes ? first + lane : second + (lane - TriangleBlock::kLanes));
    }

    static HWY_INLINE V set(float value)
    {
        return hn::Set(D(), value);
    }
    static HWY_INLINE V max3(V a, V b, V c)
    {
        return hn::Max(hn::Max(a, b), c);
    }
    static HWY_INLINE V sum_of_sizes(const V (&v)[3])
    {
        return hn::Add(hn::Abs(v[0]), hn::Add(hn::Abs(v[1]), hn::Abs(v[2])));
    }
    static HWY_INLINE V cross(const V (&a)[3], const V (&b)[3], std::size_t axis)
    {
        const std::size_t i = axis == 2 ? 0 : axis + 1, j = i == 2 ? 0 : i + 1;
        return hn::MulSub(a[i], b[j], hn::Mul(a[j], b[i]));
    }

    // Errors, relative ones in units of 2^-24. A is the farthest corner's largest coordinate from the apex, L that of the
    // longest edge, w at most kSteepest. Corners from the apex have 2, the apex being two floats, and 2^-45 of the
    // coordinates' size, which `blur` takes in; edges from corner to corner 1. A product of both, subtracted from
    // another, has 5, of edges 4; so an edge function has w * 5 * 6 A L at most, a determinant w * 4 * 6 L^2, a
    // volume 4 * 6 L^2 A and 5 of |whole|_1 A. Evaluating one, the slopes (4 roundings), two products and sums make
    // less than 16 |n|_1, also where it is the corner of a group's bounds that is asked. The double test itself
    // computes in double from the rays' own origins, up to `reach` farther: 2^-47 (A + reach)^2 in an edge function.
    // Lines that pass `aside` from the apex shift edge functions by less than 4 * aside * |edge|_1. Corners that are more
    // than floats are off by up to 2^-24 of the coordinates' size: their own part is in `blur`, that of their edges is as
    // if those were longer by twice the size; in a product of two edges the square of that is left over. What is below
    // float's range is less than 2^-110. Slopes of corners have six roundings, those of rays four.
    HWY_INLINE void see_lanes(const TriangleBlock* blocks, unsigned count, unsigned lane, FanLeaf& out) const
    {
        const D d;
        const TriangleBlock &first = blocks[0], &second = blocks[count - 1];
        const std::size_t axes[3] = {fan_.x, fan_.y, fan_.z};
        const V blur = set(fan_.blur), reach = set(fan_.reach), tiny = set(0x1p-110f);
        V at[3][3], corner[3][3], along[3][3]; // from the apex; from the corner to the next
        V farthest = hn::Zero(d), longest = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const V high = set(fan_.apex_high[axis]), low = set(fan_.apex_low[axis]);
            for (std::size_t k = 0; k < 3; ++k) {
                at[k][axis] = load(first.corners[k][axes[axis]], second.corners[k][axes[axis]], lane);
                if (axis == 2) at[k][axis] = hn::Xor(at[k][axis], set(fan_.turned ? -0.0f : 0.0f));
                corner[k][axis] = hn::Sub(hn::Sub(at[k][axis], high), low);
                farthest = hn::Max(farthest, hn::Abs(corner[k][axis]));
            }
            for (std::size_t k = 0; k < 3; ++k) {
                along[k][axis] = hn::Sub(at[k == 2 ? 0 : k + 1][axis], at[k][axis]);
                longest = hn::Max(longest, hn::Abs(along[k][axis]));
            }
        }
        V edge[3][3], whole[3], largest = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis)
            whole[axis] = cross(along[0], along[1], axis);
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                edge[k][axis] = cross(corner[k], along[k], axis);
            largest = hn::Max(largest, sum_of_sizes(edge[k]));
        }
        // As if they were longer where corners are more than the floats that are seen.
        const V stretched = hn::Add(longest, set(fan_.rounded));
        const V size_of_whole = sum_of_sizes(whole),
                longest_squared = hn::Mul(stretched, hn::MulAdd(stretched, set(0x1p-21f), longest));
        const V reached = hn::Add(farthest, reach), squared = hn::Mul(reached, reached);
        const V edge_error =
            hn::MulAdd(set(0x1p-20f),
                       hn::MulAdd(set(2.5f), hn::Mul(farthest, stretched), largest),
                       hn::MulAdd(longest, set(4 * fan_.blur), hn::MulAdd(squared, set(0x1p-44f), tiny)));
        // The side that float sees, for a first sieve.
        const V volume = hn::MulAdd(
            whole[0], corner[0][0], hn::MulAdd(whole[1], corner[0][1], hn::Mul(whole[2], corner[0][2])));
        const V volume_error =
            hn::MulAdd(hn::MulAdd(longest_squared, set(0x1.8p-20f), hn::Mul(size_of_whole, set(0x1.4p-22f))),
                       farthest,
                       hn::MulAdd(size_of_whole,
                                  blur,
                                  hn::MulAdd(hn::Mul(longest, set(0x1p-40f)),
                                             squared,
                                             hn::Mul(hn::Add(farthest, set(1)), tiny))));
        const M seen_from_outside = hn::Gt(volume, volume_error),
                seen_from_inside = hn::Gt(hn::Neg(volume), volume_error);

        // Outside of what all rays together may hit: beyond an edge, behind or before.
        const V depth_slack = hn::MulAdd(farthest, set(0x1p-21f), blur);
        const V nearest = hn::Sub(hn::Min(hn::Min(corner[0][2], corner[1][2]), corner[2][2]), depth_slack);
        const V behind = hn::Add(max3(corner[0][2], corner[1][2], corner[2][2]), depth_slack);
        M out_of_reach = hn::Or(hn::Lt(set(end_), nearest), hn::Lt(behind, set(fan_.all_begin)));
        V least_of_most = set(std::numeric_limits<float>::infinity()), most_of_least = hn::Neg(least_of_most);
        for (const auto& e : edge) {
            const V middle = hn::MulAdd(e[0], set(fan_.middle_x), hn::MulAdd(e[1], set(fan_.middle_y), e[2]));
            const V span =
                hn::MulAdd(hn::Abs(e[0]), set(fan_.half_x), hn::Mul(hn::Abs(e[1]), set(fan_.half_y)));
            least_of_most = hn::Min(least_of_most, hn::Add(middle, span));
            most_of_least = hn::Max(most_of_least, hn::Sub(middle, span));
        }
        const M beyond = hn::Or(hn::And(seen_from_outside, hn::Lt(least_of_most, hn::Neg(edge_error))),
                                hn::And(seen_from_inside, hn::Lt(edge_error, most_of_least)));
        const hn::RebindToUnsigned<D> du;
        const auto empty = hn::RebindMask(
            d, hn::Eq(load(first.primitive, second.primitive, lane), hn::Set(du, TriangleBlock::kNone)));
        out_of_reach = hn::Or(hn::Or(out_of_reach, empty), beyond);
        const unsigned there = (1u << (count * TriangleBlock::kLanes - lane)) - 1;
        const unsigned meeting = ~bits_of(d, out_of_reach) & ((1u << kSeenAtOnce) - 1) & there;
        if (meeting == 0) return;
        out.meeting |= meeting << lane;
        const auto store = [&](V value, float* to) HWY_ATTR { hn::Store(value, d, to + lane); };
        V flip = hn::CopySign(hn::Zero(d), volume); // makes the side that is seen the inner one
        if constexpr (kPrecise) {
            // What float makes of the plane tells its size well enough, where what that may be off by is added.
            const V of_corners = fan_.rounded > 0 ? longest_squared : hn::Zero(d);
            const V slack =
                hn::MulAdd(hn::MulAdd(longest_squared, set(0x1.8p-20f), size_of_whole),
                           blur,
                           hn::MulAdd(hn::Mul(of_corners, set(0x1.8p-20f)),
                                      reached,
                                      hn::MulAdd(hn::Mul(longest, set(0x1p-40f)), squared, tiny)));
            const V whole_error = hn::MulAdd(
                size_of_whole,
                set(0x1p-20f),
                hn::MulAdd(of_corners, set(0x1p-19f), hn::MulAdd(longest_squared, set(0x1p-39f), tiny)));
            flip = see_planes(at, slack, whole_error, lane, out);
            store(hn::Add(whole_error, whole_error), out.whole_slack);
        } else {
            const V size = hn::Abs(volume), error = hn::MulAdd(size, set(0x1p-22f), volume_error);
            out.faces |= bits_of(d, hn::Gt(size, error)) << lane;
            store(hn::Sub(size, error), out.least_volume);
            store(hn::Add(size, error), out.most_volume);
            const V whole_error =
                hn::MulAdd(size_of_whole, set(0x1p-20f), hn::MulAdd(longest_squared, set(0x1p-19f), tiny));
            for (std::size_t axis = 0; axis < 2; ++axis)
                store(hn::Xor(whole[axis], flip), out.whole[axis]);
            store(hn::Add(hn::Xor(whole[2], flip), whole_error), out.whole[2]);
            store(hn::Add(whole_error, whole_error), out.whole_slack);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 2; ++axis)
                store(hn::Xor(edge[k][axis], flip), out.edge[k][axis]);
            store(hn::Add(hn::Xor(edge[k][2], flip), edge_error), out.edge[k][2]);
        }
        store(hn::Add(edge_error, edge_error), out.edge_slack);
        store(nearest, out.nearest);
        store(behind, out.farthest);
        bound_slopes(corner, depth_slack, lane, out);
    }

    // Planes and depths in double; `slack` says what these are off by. The signs that make the sides that are seen the
    // inner ones.
    HWY_INLINE V
    see_planes(const V (&corners)[3][3], V slack, V whole_error, unsigned lane, FanLeaf& out) const
    {
        const auto flips_of = [&](auto part) HWY_ATTR {
            return see_planes_of(part, corners, slack, whole_error, lane, out);
        };
#if HWY_TARGET != HWY_SCALAR && HWY_MAX_BYTES < 64
        return hn::Combine(D(), flips_of(SecondPart()), flips_of(FirstPart()));
#else
        return flips_of(FirstPart());
#endif
    }

    // As many doubles as a vector takes: all triangles, or one half of them and then the other.
    using Doubles = hn::CappedTag<double, kSeenAtOnce>;
    using Floats = hn::Rebind<float, Doubles>;
    static constexpr unsigned kPlanesAtOnce = hn::MaxLanes(Doubles());
    using FirstPart = std::integral_constant<unsigned, 0>;
    using SecondPart = std::integral_constant<unsigned, kPlanesAtOnce>;

    static HWY_INLINE hn::Vec<Doubles> widen(FirstPart, hn::Vec<Floats> v)
    {
        return hn::PromoteTo(Doubles(), v);
    }
#if HWY_TARGET != HWY_SCALAR && HWY_MAX_BYTES < 64
    static HWY_INLINE hn::Vec<Doubles> widen(FirstPart, V v)
    {
        return hn::PromoteTo(Doubles(), hn::LowerHalf(Floats(), v));
    }
    static HWY_INLINE hn::Vec<Doubles> widen(SecondPart, V v)
    {
        return hn::PromoteTo(Doubles(), hn::UpperHalf(Floats(), v));
    }
#endif

    template <class Part>
    HWY_INLINE hn::Vec<Floats> see_planes_of(
        Part part, const V (&corners)[3][3], V slack, V whole_error, unsigned lane, FanLeaf& out) const
    {
        const Doubles d;
        const Floats f;
        using W = hn::Vec<Doubles>;
        const auto set = [&](double value) HWY_ATTR { return hn::Set(d, value); };
        W corner[3], along[2][3], whole[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const W a = widen(part, corners[0][axis]), b = widen(part, corners[1][axis]),
                    c = widen(part, corners[2][axis]);
            corner[axis] = hn::Sub(a, set(axis == 2 ? fan_.apex.z * fan_.sign() : fan_.apex[axis]));
            along[0][axis] = hn::Sub(b, a);
            along[1][axis] = hn::Sub(c, b);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t j = axis == 2 ? 0 : axis + 1, k = j == 2 ? 0 : j + 1;
            whole[axis] = hn::MulSub(along[0][j], along[1][k], hn::Mul(along[0][k], along[1][j]));
        }
        const W volume =
            hn::MulAdd(whole[0], corner[0], hn::MulAdd(whole[1], corner[1], hn::Mul(whole[2], corner[2])));
        const W flip = hn::CopySign(hn::Zero(d), volume), size = hn::Abs(volume);
        const W error = hn::MulAdd(size, set(0x1p-22), widen(part, slack));
        out.faces |= bits_of(d, hn::Gt(size, error)) << (lane + part);
        const auto store = [&](W value, float* to)
                               HWY_ATTR { hn::Store(hn::DemoteTo(f, value), f, to + lane + part); };
        store(hn::Sub(size, error), out.least_volume);
        store(hn::Add(size, error), out.most_volume);
        for (std::size_t axis = 0; axis < 2; ++axis)
            store(hn::Xor(whole[axis], flip), out.whole[axis]);
        store(hn::Add(hn::Xor(whole[2], flip), widen(part, whole_error)), out.whole[2]);
        return hn::DemoteTo(f, flip);
    }

    HWY_INLINE void bound_slopes(const V (&corner)[3][3], V depth_slack, unsigned lane, FanLeaf& out) const
    {
        const D d;
        const V nearest = hn::Min(hn::Min(corner[0][2], corner[1][2]), corner[2][2]);
        V inverse[3];
        for (std::size_t k = 0; k < 3; ++k)
            inverse[k] = hn::Div(set(1), corner[k][2]);
        // Of what is not clearly beyond the apex: a blur without end.
        const V blur = hn::IfThenElse(hn::Lt(depth_slack, nearest),
                                      hn::Mul(set(fan_.blur), max3(inverse[0], inverse[1], inverse[2])),
                                      set(std::numeric_limits<float>::infinity()));
        const auto bound = [&](std::size_t axis, float* least, float* most) HWY_ATTR {
            const V a = hn::Mul(corner[0][axis], inverse[0]), b = hn::Mul(corner[1][axis], inverse[1]),
                    c = hn::Mul(corner[2][axis], inverse[2]);
            const V lower = hn::Min(a, hn::Min(b, c)), upper = max3(a, b, c);
            const V slack = hn::MulAdd(hn::Max(hn::Abs(lower), hn::Abs(upper)), set(0x1p-20f), blur);
            hn::Store(hn::Sub(lower, slack), d, least + lane);
            hn::Store(hn::Add(upper, slack), d, most + lane);
        };
        bound(0, out.least_x, out.most_x);
        bound(1, out.least_y, out.most_y);
    }

    const RayFan& fan_;
    float end_; // of the ray that runs farthest
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
