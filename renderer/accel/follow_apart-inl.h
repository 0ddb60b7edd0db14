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

#include "renderer/accel/look_at_leaf-inl.h"
#include "renderer/accel/prepare_apart-inl.h"
#include "renderer/accel/settle_apart-inl.h"

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
        settle();
    }

private:
    // A triangle that may be the closest: which, and where it is at the earliest.
    struct Candidate {
        std::uint32_t place; // block * lanes + lane
        float least;
    };
    static constexpr unsigned kCandidates = 8, kInFlight = 16;

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
            if (primitive_at(mesh_, place) == TriangleBlock::kNone) continue;
            if (found_[ray] == kCandidates) decide(ray);
            candidates_[ray][found_[ray]++] = {place, look.least[lane]};
        }
        if (kAnyHit && best_[ray].primitive != TriangleBlock::kNone) end_with_hit(ray);
    }

    HWY_INLINE void end_with_hit(unsigned ray)
    {
        run_.end[ray] = -std::numeric_limits<float>::infinity();
        best_[ray].primitive = 0;
    }

    // Tests the candidates that are left.
    HWY_NOINLINE void decide(unsigned ray)
    {
        const LoneTests tests(mesh_, run_, rays_, best_);
        for (unsigned i = 0; i < found_[ray]; ++i)
            if (!(candidates_[ray][i].least > run_.end[ray])) tests.test(ray, candidates_[ray][i].place);
        found_[ray] = 0;
        if (best_[ray].primitive != TriangleBlock::kNone)
            run_.end[ray] = std::min(run_.end[ray], run_.end_for(best_[ray].t, ray));
    }

    // The candidates that are left, of all rays. Where any hit will do few of them are hits: most are what a shadow ray starts
    // on, so that its ray had better go on than wait for a test alone.
    HWY_INLINE void settle()
    {
        LoneTests tests(mesh_, run_, rays_, best_);
        for (std::uint64_t left = run_.rays; left != 0; left &= left - 1) {
            const auto ray = static_cast<unsigned>(std::countr_zero(left));
            for (unsigned i = 0; i < found_[ray]; ++i)
                if (!(candidates_[ray][i].least > run_.end[ray])) tests.ask(ray, candidates_[ray][i].place);
        }
        tests.finish();
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
