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
    static HWY_INLINE V tiny()
    {
        return set(0x1p-110f);
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

    // As many triangles as a vector has lanes, seen in float.
    struct Triangles {
        V at[3][3], corner[3][3], along[3][3]; // [corner][axis]; from the apex; from the corner to the next
        V farthest, longest, longest_squared;  // of the errors' A and L
        V reached, reached_squared;
        V edge[3][3], edge_error;
        V whole[3], size_of_whole, volume, volume_error;
        V nearest, behind;        // certain bounds of the depths
        HWY_INLINE Triangles() {} // one that is implied would not be of this target
    };

    HWY_INLINE void
    read(const TriangleBlock& first, const TriangleBlock& second, unsigned lane, Triangles& t) const
    {
        const std::size_t axes[3] = {fan_.x, fan_.y, fan_.z};
        t.farthest = t.longest = hn::Zero(D());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const V high = set(fan_.apex_high[axis]), low = set(fan_.apex_low[axis]);
            for (std::size_t k = 0; k < 3; ++k) {
                V& at = t.at[k][axis];
                at = load(first.corners[k][axes[axis]], second.corners[k][axes[axis]], lane);
                if (axis == 2) at = hn::Xor(at, set(fan_.turned ? -0.0f : 0.0f));
                t.corner[k][axis] = hn::Sub(hn::Sub(at, high), low);
                t.farthest = hn::Max(t.farthest, hn::Abs(t.corner[k][axis]));
            }
            for (std::size_t k = 0; k < 3; ++k) {
                t.along[k][axis] = hn::Sub(t.at[k == 2 ? 0 : k + 1][axis], t.at[k][axis]);
                t.longest = hn::Max(t.longest, hn::Abs(t.along[k][axis]));
            }
        }
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
    HWY_INLINE void measure(Triangles& t) const
    {
        const D d;
        V largest = hn::Zero(d);
        for (std::size_t axis = 0; axis < 3; ++axis)
            t.whole[axis] = cross(t.along[0], t.along[1], axis);
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                t.edge[k][axis] = cross(t.corner[k], t.along[k], axis);
            largest = hn::Max(largest, sum_of_sizes(t.edge[k]));
        }
        // As if they were longer where corners are more than the floats that are seen.
        const V stretched = hn::Add(t.longest, set(fan_.rounded)), blur = set(fan_.blur);
        t.size_of_whole = sum_of_sizes(t.whole);
        t.longest_squared = hn::Mul(stretched, hn::MulAdd(stretched, set(0x1p-21f), t.longest));
        t.reached = hn::Add(t.farthest, set(fan_.reach));
        t.reached_squared = hn::Mul(t.reached, t.reached);
        t.edge_error = hn::MulAdd(
            set(0x1p-20f),
            hn::MulAdd(set(2.5f), hn::Mul(t.farthest, stretched), largest),
            hn::MulAdd(t.longest, set(4 * fan_.blur), hn::MulAdd(t.reached_squared, set(0x1p-44f), tiny())));
        // The side that float sees, for a first sieve.
        const V(&c)[3] = t.corner[0];
        t.volume = hn::MulAdd(t.whole[0], c[0], hn::MulAdd(t.whole[1], c[1], hn::Mul(t.whole[2], c[2])));
        t.volume_error = hn::MulAdd(
            hn::MulAdd(t.longest_squared, set(0x1.8p-20f), hn::Mul(t.size_of_whole, set(0x1.4p-22f))),
            t.farthest,
            hn::MulAdd(t.size_of_whole,
                       blur,
                       hn::MulAdd(hn::Mul(t.longest, set(0x1p-40f)),
                                  t.reached_squared,
                                  hn::Mul(hn::Add(t.farthest, set(1)), tiny()))));
        const V depth_slack = hn::MulAdd(t.farthest, set(0x1p-21f), blur);
        t.nearest = hn::Sub(hn::Min(hn::Min(t.corner[0][2], t.corner[1][2]), t.corner[2][2]), depth_slack);
        t.behind = hn::Add(max3(t.corner[0][2], t.corner[1][2], t.corner[2][2]), depth_slack);
    }

    // Outside of what all rays together may hit: beyond an edge, behind or before.
    HWY_INLINE M out_of_reach(const Triangles& t) const
    {
        V least_of_most = set(std::numeric_limits<float>::infinity()), most_of_least = hn::Neg(least_of_most);
        for (const auto& e : t.edge) {
            const V middle = hn::MulAdd(e[0], set(fan_.middle_x), hn::MulAdd(e[1], set(fan_.middle_y), e[2]));
            const V span =
                hn::MulAdd(hn::Abs(e[0]), set(fan_.half_x), hn::Mul(hn::Abs(e[1]), set(fan_.half_y)));
            least_of_most = hn::Min(least_of_most, hn::Add(middle, span));
            most_of_least = hn::Max(most_of_least, hn::Sub(middle, span));
        }
        const M seen_from_outside = hn::Gt(t.volume, t.volume_error),
                seen_from_inside = hn::Gt(hn::Neg(t.volume), t.volume_error);
        const M beyond = hn::Or(hn::And(seen_from_outside, hn::Lt(least_of_most, hn::Neg(t.edge_error))),
                                hn::And(seen_from_inside, hn::Lt(t.edge_error, most_of_least)));
        return hn::Or(hn::Or(hn::Lt(set(end_), t.nearest), hn::Lt(t.behind, set(fan_.all_begin))), beyond);
    }

    HWY_INLINE void see_lanes(const TriangleBlock* blocks, unsigned count, unsigned lane, FanLeaf& out) const
    {
        const D d;
        const TriangleBlock &first = blocks[0], &second = blocks[count - 1];
        Triangles t;
        read(first, second, lane, t);
        measure(t);
        const hn::RebindToUnsigned<D> du;
        const auto empty = hn::RebindMask(
            d, hn::Eq(load(first.primitive, second.primitive, lane), hn::Set(du, TriangleBlock::kNone)));
        const unsigned there = (1u << (count * TriangleBlock::kLanes - lane)) - 1;
        const unsigned meeting =
            ~bits_of(d, hn::Or(out_of_reach(t), empty)) & ((1u << kSeenAtOnce) - 1) & there;
        if (meeting == 0) return;
        out.meeting |= meeting << lane;
        const auto store = [&](V value, float* to) HWY_ATTR { hn::Store(value, d, to + lane); };
        const V flip = kPrecise ? tell_planes_in_double(t, lane, out) : tell_planes_in_float(t, lane, out);
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 2; ++axis)
                store(hn::Xor(t.edge[k][axis], flip), out.edge[k][axis]);
            store(hn::Add(hn::Xor(t.edge[k][2], flip), t.edge_error), out.edge[k][2]);
        }
        store(hn::Add(t.edge_error, t.edge_error), out.edge_slack);
        store(t.nearest, out.nearest);
        store(t.behind, out.farthest);
        bound_slopes(t, lane, out);
    }

    // The planes, and the signs that make the sides that are seen the inner ones.
    HWY_INLINE V tell_planes_in_float(const Triangles& t, unsigned lane, FanLeaf& out) const
    {
        const D d;
        const auto store = [&](V value, float* to) HWY_ATTR { hn::Store(value, d, to + lane); };
        const V flip = hn::CopySign(hn::Zero(d), t.volume), size = hn::Abs(t.volume);
        const V error = hn::MulAdd(size, set(0x1p-22f), t.volume_error);
        out.faces |= bits_of(d, hn::Gt(size, error)) << lane;
        store(hn::Sub(size, error), out.least_volume);
        store(hn::Add(size, error), out.most_volume);
        const V whole_error =
            hn::MulAdd(t.size_of_whole, set(0x1p-20f), hn::MulAdd(t.longest_squared, set(0x1p-19f), tiny()));
        for (std::size_t axis = 0; axis < 2; ++axis)
            store(hn::Xor(t.whole[axis], flip), out.whole[axis]);
        store(hn::Add(hn::Xor(t.whole[2], flip), whole_error), out.whole[2]);
        store(hn::Add(whole_error, whole_error), out.whole_slack);
        return flip;
    }

    HWY_INLINE V tell_planes_in_double(const Triangles& t, unsigned lane, FanLeaf& out) const
    {
        const D d;
        // What float makes of the plane tells its size well enough, where what that may be off by is added.
        const V of_corners = fan_.rounded > 0 ? t.longest_squared : hn::Zero(d);
        const V slack =
            hn::MulAdd(hn::MulAdd(t.longest_squared, set(0x1.8p-20f), t.size_of_whole),
                       set(fan_.blur),
                       hn::MulAdd(hn::Mul(of_corners, set(0x1.8p-20f)),
                                  t.reached,
                                  hn::MulAdd(hn::Mul(t.longest, set(0x1p-40f)), t.reached_squared, tiny())));
        const V whole_error = hn::MulAdd(
            t.size_of_whole,
            set(0x1p-20f),
            hn::MulAdd(of_corners, set(0x1p-19f), hn::MulAdd(t.longest_squared, set(0x1p-39f), tiny())));
        hn::Store(hn::Add(whole_error, whole_error), d, out.whole_slack + lane);
        return see_planes(t.at, slack, whole_error, lane, out);
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

    HWY_INLINE void bound_slopes(const Triangles& t, unsigned lane, FanLeaf& out) const
    {
        const D d;
        const V(&corner)[3][3] = t.corner;
        V inverse[3];
        for (std::size_t k = 0; k < 3; ++k)
            inverse[k] = hn::Div(set(1), corner[k][2]);
        // Of what is not clearly beyond the apex: a blur without end.
        const V blur = hn::IfThenElse(hn::Lt(hn::Zero(d), t.nearest),
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
