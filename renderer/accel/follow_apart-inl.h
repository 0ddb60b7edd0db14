// Rays that have nothing in common, through a mesh: many in flight in one thread, a step of each in turn, so that
// the memory one waits for arrives while the others work. Included by mesh_kernels.cpp, once a target.
//
// Those that stand before a node and those that stand before a leaf are kept apart, and what a step finds is
// sorted without a branch: a branch that cannot be foreseen costs as much as the box test itself.
#if defined(HELIOGRAPH_FOLLOW_APART_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_FOLLOW_APART_INL
#undef HELIOGRAPH_FOLLOW_APART_INL
#else
#define HELIOGRAPH_FOLLOW_APART_INL
#endif

#include "renderer/accel/exact_test.h"
#include "renderer/accel/prepare_apart-inl.h"
#include "renderer/accel/triangle_lanes-inl.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// What a ray still has to visit, the nearest on top: where it is entered, and its code.
struct alignas(64) Ahead {
    static constexpr std::uint32_t kNothing = ChildCode::kLeaf - 1; // the lowest: the ray has ended
    static constexpr unsigned kRoom = (kMostWaiting + WideNode::kChildren + 15) / 16 * 16;

    std::int32_t entry[kRoom]; // a float's bits
    std::uint32_t code[kRoom];
    std::size_t count;

    HWY_INLINE void clear()
    {
        entry[0] = std::bit_cast<std::int32_t>(-std::numeric_limits<float>::infinity());
        code[0] = kNothing;
        count = 1;
    }
    // The next one that is entered no later than `end`.
    HWY_INLINE std::uint32_t pop(float end)
    {
        std::size_t at = count;
        do
            --at;
        while (std::bit_cast<float>(entry[at]) > end);
        count = at;
        return code[at];
    }
};
// An odd number of cache lines: else all would share the same few sets.
static_assert(sizeof(Ahead) / 64 % 2 == 1);

// The children that were entered, onto the stack, the nearer above the farther.
struct PushAt {
    std::size_t lane; // of the first child
    std::size_t base; // of the stack, where the node's children begin
};

#if HWY_MAX_BYTES >= 32

// Sorted, the greatest first.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V sort_eight(D d, V v)
{
    const auto upper_of_four = hn::Ne(hn::And(hn::Iota(d, 0), hn::Set(d, 2)), hn::Zero(d));
    const auto by_pairs = [&](V a, V b) HWY_ATTR { return hn::OddEven(hn::Min(a, b), hn::Max(a, b)); };
    const auto by_fours = [&](V a, V b) HWY_ATTR {
        return hn::IfThenElse(upper_of_four, hn::Min(a, b), hn::Max(a, b));
    };
    v = by_pairs(v, hn::Shuffle2301(v));
    v = by_fours(v, hn::Shuffle0123(v));
    v = by_pairs(v, hn::Shuffle2301(v));
    const V opposite = hn::Reverse(d, v);
    v = hn::ConcatUpperLower(d, hn::Min(v, opposite), hn::Max(v, opposite));
    v = by_fours(v, hn::Shuffle1032(v));
    return by_pairs(v, hn::Shuffle2301(v));
}

// A child's place takes the last three bits of its entry, so that both are sorted at once.
HWY_INLINE void
push(Ahead& ahead, const WideNode& node, PushAt, hn::Vec<Eight> entry, hn::Mask<Eight> entered)
{
    const Eight d;
    const hn::RebindToSigned<Eight> di;
    const hn::RebindToUnsigned<Eight> du;
    const auto place = hn::Set(di, 7);
    const auto key = hn::Or(hn::AndNot(place, hn::BitCast(di, entry)), hn::Iota(di, 0));
    const auto sorted = sort_eight(di, hn::IfThenElse(hn::RebindMask(di, entered), key, hn::Set(di, -1)));
    const auto places = hn::BitCast(du, hn::And(sorted, place));
    const std::size_t count = ahead.count;
    ahead.count = count + hn::CountTrue(d, entered);
    hn::StoreU(sorted, di, ahead.entry + count);
    hn::StoreU(hn::TableLookupLanes(hn::Load(du, node.child), hn::IndicesFromVec(du, places)),
               du,
               ahead.code + count);
}

#else

HWY_INLINE void
push(Ahead& ahead, const WideNode& node, PushAt at_lanes, hn::Vec<Eight> entry, hn::Mask<Eight> entered)
{
    const Eight d;
    alignas(16) std::int32_t entries[hn::MaxLanes(d)];
    hn::Store(hn::BitCast(hn::RebindToSigned<Eight>(), entry), hn::RebindToSigned<Eight>(), entries);
    for (unsigned hits = bits_of(d, entered); hits != 0; hits &= hits - 1) {
        const auto i = static_cast<unsigned>(__builtin_ctz(hits));
        std::size_t at = ahead.count++;
        for (; at > at_lanes.base && ahead.entry[at - 1] < entries[i]; --at) {
            ahead.entry[at] = ahead.entry[at - 1];
            ahead.code[at] = ahead.code[at - 1];
        }
        ahead.entry[at] = entries[i];
        ahead.code[at] = node.child[at_lanes.lane + i];
    }
}

#endif

// Leaves the children that the ray enters on the stack.
HWY_INLINE void visit_node(const WideNode& node, const LoneRays& run, unsigned ray, Ahead& ahead)
{
    const Eight d;
    // The reciprocal's roundings, and the bits of an entry that its child's place takes.
    const auto factor = hn::Set(d, 1 - 0x1p-19f);
    const std::size_t base = ahead.count;
    for (std::size_t lane = 0; lane < WideNode::kChildren; lane += hn::MaxLanes(d)) {
        auto entry = hn::Set(d, run.begin[ray]), exit = hn::Set(d, run.end[ray]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto plane = [&](std::size_t row) HWY_ATTR {
                const auto* const bytes = reinterpret_cast<const char*>(node.planes) + row;
                return hn::Load(d, reinterpret_cast<const float*>(bytes) + lane);
            };
            const std::size_t row = run.near_row[axis][ray];
            const auto inverse = hn::Set(d, run.inverse[axis][ray]);
            entry = hn::Max(entry, hn::MulAdd(plane(row), inverse, hn::Set(d, run.near_shift[axis][ray])));
            exit = hn::Min(exit, hn::MulAdd(plane(row ^ 32), inverse, hn::Set(d, run.far_shift[axis][ray])));
        }
        entry = hn::Mul(entry, factor);
        const auto entered = hn::Le(entry, exit);
        push(ahead, node, {lane, base}, hn::Max(entry, hn::Zero(d)), entered);
    }
}

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

template <bool kAnyHit>
class LoneWalk {
public:
    HWY_INLINE LoneWalk(const MeshView& mesh, LoneRays& run, const Ray* rays, MeshHit* best)
        : mesh_(mesh), run_(run), rays_(rays), best_(best)
    {
    }

    HWY_INLINE void walk()
    {
        for (unsigned i = 0; i < kInFlight; ++i)
            free_[i] = ahead_ + i;
        std::uint64_t left = run_.rays;
        for (;;) {
            for (; left != 0 && frees_ != 0; left &= left - 1)
                board(static_cast<unsigned>(std::countr_zero(left)));
            if ((before_node_ | before_leaf_) == 0) break;
            visit_nodes();
            visit_leaves();
        }
        if (!kAnyHit) settle();
    }

private:
    // A triangle that may be the closest: which, and where it is at the earliest.
    struct Candidate {
        std::uint32_t place; // block * lanes + lane
        float least;
    };
    static constexpr unsigned kCandidates = 8, kInFlight = 16;

    // A ray that the double test is asked about, and with which triangle.
    struct Asked {
        unsigned ray;
        std::uint32_t place;
    };
    using D = TriangleLanes::D;
    using V = TriangleLanes::V;
    static constexpr unsigned kTogether = TriangleLanes::kLanes;
    static constexpr std::size_t kRow = sizeof(TriangleBlock::corners[0][0]); // LoneRays::Axes count bytes

    // In two rounds: nothing in the first depends on a branch, and what the second branches on is known by then.
    HWY_INLINE void visit_nodes()
    {
        const unsigned nodes = before_node_;
        for (unsigned i = 0; i < nodes; ++i) {
            const unsigned ray = at_node_[i];
            visit_node(mesh_.nodes[code_[ray]], run_, ray, (*ahead_of_[ray]));
        }
        before_node_ = 0;
        for (unsigned i = 0; i < nodes; ++i) {
            const unsigned ray = at_node_[i];
            route(ray, ahead_of_[ray]->pop(run_.end[ray]));
        }
    }
    HWY_INLINE void visit_leaves()
    {
        const unsigned leaves = before_leaf_;
        for (unsigned i = 0; i < leaves; ++i) {
            const unsigned ray = at_leaf_[i];
            const TriangleBlock* const block = mesh_.leaves + (code_[ray] & ChildCode::kNumber);
            const bool two = (code_[ray] & ChildCode::kTwoBlocks) != 0;
            const TriangleBlock* const blocks[2] = {block, block + (two ? 1 : 0)};
            look_at_leaf(run_, ray, blocks, looks_[i]);
            looks_[i].may &= two ? 0xffu : 0x0fu;
        }
        before_leaf_ = 0;
        for (unsigned i = 0; i < leaves; ++i) {
            const unsigned ray = at_leaf_[i];
            if (looks_[i].may != 0) take(ray, looks_[i]);
            route(ray, ahead_of_[ray]->pop(run_.end[ray]));
        }
    }

    HWY_INLINE void board(unsigned ray)
    {
        ahead_of_[ray] = free_[--frees_];
        ahead_of_[ray]->clear();
        found_[ray] = 0;
        route(ray, 0);
    }

    // To what the ray visits next, which is asked for now.
    HWY_INLINE void route(unsigned ray, std::uint32_t code)
    {
        if (code == Ahead::kNothing) {
            free_[frees_++] = ahead_of_[ray];
            return;
        }
        code_[ray] = code;
        const bool leaf = (code & ChildCode::kLeaf) != 0;
        const char* const of_leaf = reinterpret_cast<const char*>(mesh_.leaves + (code & ChildCode::kNumber));
        const char* const of_node = reinterpret_cast<const char*>(mesh_.nodes + code);
        const char* const bytes = leaf ? of_leaf : of_node;
        static_assert(sizeof(WideNode) <= 256);
        __builtin_prefetch(bytes);
        __builtin_prefetch(bytes + 64);
        __builtin_prefetch(bytes + 128);
        __builtin_prefetch(bytes + 192);
        at_leaf_[before_leaf_] = ray;
        at_node_[before_node_] = ray;
        before_leaf_ += leaf ? 1u : 0u;
        before_node_ += leaf ? 0u : 1u;
    }

    HWY_INLINE void take(unsigned ray, const Look& look)
    {
        const std::uint32_t number = code_[ray] & ChildCode::kNumber;
        if (kAnyHit && (look.sure & look.may) != 0) {
            end_with_hit(ray);
            return;
        }
        for (unsigned sure = look.sure & look.may; sure != 0; sure &= sure - 1) {
            const auto lane = static_cast<unsigned>(__builtin_ctz(sure));
            // Depths of other triangles are off by `lateral` at most, their boxes too.
            run_.end[ray] = std::min(run_.end[ray], look.most[lane] + 4 * run_.lateral[ray]);
        }
        for (unsigned may = look.may; may != 0; may &= may - 1) {
            const auto lane = static_cast<unsigned>(__builtin_ctz(may));
            if (look.least[lane] > run_.end[ray]) continue;
            const std::uint32_t place = number * TriangleBlock::kLanes + lane;
            if (primitive(place) == TriangleBlock::kNone) continue;
            if (found_[ray] == kCandidates) decide(ray);
            candidates_[ray][found_[ray]++] = {place, look.least[lane]};
        }
        if (kAnyHit && found_[ray] != 0) {
            decide(ray);
            if (best_[ray].primitive != TriangleBlock::kNone) end_with_hit(ray);
        }
    }

    HWY_INLINE void end_with_hit(unsigned ray)
    {
        run_.end[ray] = -std::numeric_limits<float>::infinity();
        best_[ray].primitive = 0;
    }

    std::uint32_t primitive(std::uint32_t place) const
    {
        return mesh_.leaves[place / TriangleBlock::kLanes].primitive[place % TriangleBlock::kLanes];
    }

    // Tests the candidates that are left.
    HWY_NOINLINE void decide(unsigned ray)
    {
        for (unsigned i = 0; i < found_[ray]; ++i)
            if (!(candidates_[ray][i].least > run_.end[ray]))
                improve({ray, candidates_[ray][i].place}, best_[ray]);
        found_[ray] = 0;
        if (best_[ray].primitive != TriangleBlock::kNone)
            run_.end[ray] = std::min(run_.end[ray], run_.end_for(best_[ray].t, ray));
    }

    // The candidates that are left, of all rays.
    HWY_INLINE void settle()
    {
        Asked asked[kTogether];
        unsigned count = 0;
        for (std::uint64_t left = run_.rays; left != 0; left &= left - 1) {
            const auto ray = static_cast<unsigned>(std::countr_zero(left));
            for (unsigned i = 0; i < found_[ray]; ++i) {
                if (candidates_[ray][i].least > run_.end[ray]) continue;
                asked[count++] = {ray, candidates_[ray][i].place};
                if (count < kTogether) continue;
                settle_some(asked, count);
                count = 0;
            }
        }
        if (count != 0) settle_some(asked, count);
    }

    // Rays and their triangles side by side, axes renamed; the last lanes may repeat the first.
    struct Batch {
        alignas(64) float corners[9][kTogether], lacking[9][kTogether];
        alignas(64) double origins[3][kTogether], directions[3][kTogether];
        alignas(64) double powers[kTogether], units[kTogether], from[kTogether], to[kTogether];
    };
    HWY_INLINE void load(const Asked* asked, unsigned count, Batch& batch) const
    {
        const bool has_residuals = mesh_.residuals != nullptr;
        for (unsigned i = 0; i < kTogether; ++i) {
            const Asked& one = asked[i < count ? i : 0];
            const Ray& ray = rays_[one.ray];
            const LoneRays::Axes named = run_.axes[one.ray];
            const std::size_t axes[3] = {named.x / kRow, named.y / kRow, named.z / kRow};
            const std::uint32_t block = one.place / TriangleBlock::kLanes;
            const std::uint32_t lane = one.place % TriangleBlock::kLanes;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (std::size_t k = 0; k < 3; ++k) {
                    batch.corners[3 * k + axis][i] = mesh_.leaves[block].corners[k][axes[axis]][lane];
                    if (has_residuals)
                        batch.lacking[3 * k + axis][i] = mesh_.residuals[block].corners[k][axes[axis]][lane];
                }
                batch.origins[axis][i] = ray.origin[axes[axis]];
                batch.directions[axis][i] = ray.direction[axes[axis]];
            }
            batch.powers[i] = run_.power[one.ray];
            batch.units[i] = run_.units[one.ray];
            batch.from[i] = ray.t_min;
            batch.to[i] = ray.t_max;
        }
    }

    HWY_INLINE void settle_some(const Asked* asked, unsigned count)
    {
        const D d;
        const hn::Rebind<float, D> f;
        const bool has_residuals = mesh_.residuals != nullptr;
        Batch batch;
        load(asked, count, batch);
        const V scale = hn::Set(d, static_cast<double>(mesh_.scale)), power = hn::Load(d, batch.powers);
        V origin[3], direction[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[axis] = hn::Mul(hn::Load(d, batch.origins[axis]), scale);
            direction[axis] = hn::Mul(hn::Load(d, batch.directions[axis]), power);
        }
        const TriangleLanes exact(origin, direction, [&](std::size_t k, std::size_t axis) HWY_ATTR {
            const V corner = hn::PromoteTo(d, hn::Load(f, batch.corners[3 * k + axis]));
            return has_residuals ? hn::Add(corner, hn::PromoteTo(d, hn::Load(f, batch.lacking[3 * k + axis])))
                                 : corner;
        });
        const V t = exact.t(), unit = hn::Load(d, batch.units);
        const V begin = hn::Mul(hn::Load(d, batch.from), unit), end = hn::Mul(hn::Load(d, batch.to), unit);
        const auto within =
            hn::And(hn::And(hn::Lt(t, end), hn::Gt(t, begin)), hn::Gt(exact.lower_bound_of_t(), begin));
        const auto plain = exact.is_plain();
        const unsigned hit = bits_of(d, hn::And(plain, within));
        const unsigned known = bits_of(d, hn::Or(plain, exact.beside()));
        alignas(64) double out[4][kTogether];
        hn::Store(t, d, out[0]);
        for (std::size_t k = 0; k < 3; ++k)
            hn::Store(exact.weight(k), d, out[1 + k]);
        for (unsigned i = 0; i < count; ++i) {
            const Asked& one = asked[i];
            MeshHit& best = best_[one.ray];
            if ((known >> i & 1) == 0) {
                improve(one, best);
                continue;
            }
            if ((hit >> i & 1) == 0) continue;
            const std::uint32_t number = primitive(one.place);
            if (out[0][i] < best.t || (out[0][i] == best.t && number < best.primitive))
                best = {out[0][i], number, {out[1][i], out[2][i], out[3][i]}};
        }
    }

    HWY_NOINLINE void improve(const Asked& one, MeshHit& best)
    {
        const Ray& r = rays_[one.ray];
        const double units = run_.units[one.ray];
        const WatertightRay<double> exact(r.origin * static_cast<double>(mesh_.scale),
                                          r.direction * run_.power[one.ray]);
        improve_hit(exact,
                    r.t_min * units,
                    r.t_max * units,
                    mesh_,
                    mesh_.leaves[one.place / TriangleBlock::kLanes],
                    one.place % TriangleBlock::kLanes,
                    best);
    }

    const MeshView& mesh_;
    LoneRays& run_;
    const Ray* rays_;
    MeshHit* best_;
    unsigned before_node_ = 0, before_leaf_ = 0;
    unsigned frees_ = kInFlight;
    // One more than there are: the last is written where nothing is to be remembered.
    unsigned at_node_[kInFlight + 1], at_leaf_[kInFlight + 1]; // rays that stand before a node, a leaf
    Ahead* free_[kInFlight];
    LoneRays::Lanes<std::uint32_t> code_; // the node or leaf
    LoneRays::Lanes<Ahead*> ahead_of_;
    LoneRays::Lanes<unsigned> found_;
    Look looks_[kInFlight];
    Candidate candidates_[LoneRays::kRays][kCandidates];
    Ahead ahead_[kInFlight];
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
