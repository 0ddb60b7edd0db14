// Rays that have nothing in common, through a mesh: several in flight in one thread, a step of each in turn, so
// that the memory one waits for arrives while the others work. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_FOLLOW_APART_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_FOLLOW_APART_INL
#undef HELIOGRAPH_FOLLOW_APART_INL
#else
#define HELIOGRAPH_FOLLOW_APART_INL
#endif

#include "renderer/accel/exact_test.h"
#include "renderer/accel/prepare_run-inl.h"

#include <utility>

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

struct Child {
    std::uint32_t code;
    float entry;
};

HWY_INLINE void enter_children(const WideNode& node, const RayRun& run, unsigned ray, Entered& out)
{
    const Eight d;
    out.children = 0;
    for (std::size_t lane = 0; lane < WideNode::kChildren; lane += hn::MaxLanes(d)) {
        auto entry = hn::Set(d, run.begin[ray]), exit = hn::Set(d, run.end[ray]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const unsigned row = run.near_row[axis][ray];
            entry = hn::Max(entry,
                            hn::MulAdd(hn::Load(d, node.planes[row] + lane),
                                       hn::Set(d, run.near_scale[axis][ray]),
                                       hn::Set(d, run.near_shift[axis][ray])));
            exit = hn::Min(exit,
                           hn::MulAdd(hn::Load(d, node.planes[row ^ 1] + lane),
                                      hn::Set(d, run.far_scale[axis][ray]),
                                      hn::Set(d, run.far_shift[axis][ray])));
        }
        hn::Store(entry, d, out.entries + lane);
        out.children |= bits_of(d, hn::Le(entry, exit)) << lane;
    }
}

// Lanes of the block that the double test might accept up to `end`.
HWY_INLINE unsigned may_hit(const RayRun& run, unsigned ray, const TriangleBlock& block)
{
    const Four d;
    unsigned lanes = 0;
    const std::size_t kx = run.kx[ray], ky = run.ky[ray], kz = run.kz[ray];
    const auto ox = hn::Set(d, run.from[kx][ray]), oy = hn::Set(d, run.from[ky][ray]),
               oz = hn::Set(d, run.from[kz][ray]);
    const auto shear_x = hn::Set(d, run.shear_x[ray]), shear_y = hn::Set(d, run.shear_y[ray]),
               depth_scale = hn::Set(d, run.depth_scale[ray]);
    for (std::size_t lane = 0; lane < TriangleBlock::kLanes; lane += hn::MaxLanes(d)) {
        hn::Vec<Four> x[3], y[3], t[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& corner = block.corners[k];
            const auto depth = hn::Sub(hn::Load(d, corner[kz] + lane), oz);
            x[k] = hn::NegMulAdd(shear_x, depth, hn::Sub(hn::Load(d, corner[kx] + lane), ox));
            y[k] = hn::NegMulAdd(shear_y, depth, hn::Sub(hn::Load(d, corner[ky] + lane), oy));
            t[k] = hn::Mul(depth, depth_scale);
        }
        const auto out = certain_miss(
            d, x, y, t, hn::Set(d, run.lateral[ray]), hn::Set(d, run.begin[ray]), hn::Set(d, run.end[ray]));
        lanes |= (~bits_of(d, out) & ((1u << hn::MaxLanes(d)) - 1)) << lane;
    }
    return lanes;
}

// Takes the node's nearest child as the next one and leaves the others on the stack, the nearer above the
// farther. False: the ray enters none.
HWY_INLINE bool enter_node(
    const WideNode& node, const RayRun& run, unsigned ray, Child& next, Child* stack, unsigned& waiting)
{
    Entered entered;
    enter_children(node, run, ray, entered);
    unsigned hits = entered.children;
    if (hits == 0) return false;
    const auto take = [&]() HWY_ATTR {
        const auto i = static_cast<unsigned>(__builtin_ctz(hits));
        hits &= hits - 1;
        return Child{node.child[i], entered.entries[i]};
    };
    next = take();
    const unsigned base = waiting;
    while (hits != 0) {
        Child other = take();
        if (other.entry < next.entry) std::swap(other, next);
        unsigned at = waiting++;
        for (; at > base && stack[at - 1].entry < other.entry; --at)
            stack[at] = stack[at - 1];
        stack[at] = other;
    }
    return true;
}

// True where any hit will do and one was found.
template <bool kAnyHit>
HWY_INLINE bool visit_leaf(const MeshView& mesh, std::uint32_t code, RayRun& run, unsigned ray, MeshHit& best)
{
    const TriangleBlock* block = mesh.leaves + (code & ChildCode::kNumber);
    const TriangleBlock* const last = block + ((code & ChildCode::kTwoBlocks) != 0 ? 1 : 0);
    for (; block <= last; ++block)
        for (unsigned lanes = may_hit(run, ray, *block); lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<unsigned>(__builtin_ctz(lanes));
            if (!improve_hit(run.exact(ray), run.t_min[ray], run.t_max[ray], mesh, *block, lane, best)) continue;
            if (kAnyHit) return true;
            run.end[ray] = std::min(run.end[ray], run.end_for(best.t, ray));
        }
    return false;
}

// One ray on its way: what it visits next, and what waits for it.
struct Traveller {
    Child next{};
    unsigned ray = 0; // of the run
    unsigned waiting = 0;
    Child* stack = nullptr;
};

// Asks for what a child will be read from: all of a node, most of a leaf.
HWY_INLINE void fetch(const MeshView& mesh, std::uint32_t code)
{
    const bool leaf = (code & ChildCode::kLeaf) != 0;
    const auto* const bytes = leaf ? reinterpret_cast<const char*>(mesh.leaves + (code & ChildCode::kNumber))
                                   : reinterpret_cast<const char*>(mesh.nodes + code);
    static_assert(sizeof(WideNode) <= 256);
    __builtin_prefetch(bytes);
    __builtin_prefetch(bytes + 64);
    __builtin_prefetch(bytes + 128);
    __builtin_prefetch(bytes + 192);
}

// Visits a node or a leaf. False: the ray has ended.
template <bool kAnyHit>
HWY_INLINE bool step(const MeshView& mesh, RayRun& run, Traveller& t, MeshHit* best)
{
    if ((t.next.code & ChildCode::kLeaf) != 0) {
        if (visit_leaf<kAnyHit>(mesh, t.next.code, run, t.ray, best[t.ray])) return false;
    } else if (enter_node(mesh.nodes[t.next.code], run, t.ray, t.next, t.stack, t.waiting)) {
        return true;
    }
    do {
        if (t.waiting == 0) return false;
        t.next = t.stack[--t.waiting];
    } while (t.next.entry > run.end[t.ray]);
    return true;
}

template <bool kAnyHit>
HWY_INLINE void follow_apart(const MeshView& mesh, RayRun& run, MeshHit* best)
{
    constexpr unsigned kInFlight = 8;
    // An odd number of cache lines from one stack to the next: else all would share the same few sets.
    struct Stack {
        alignas(64) Child children[kMostWaiting];
    };
    static_assert(sizeof(Stack) / 64 % 2 == 1);
    Stack stacks[kInFlight];
    Traveller travellers[kInFlight];
    unsigned left = run.rays, active = 0;
    const auto board = [&](Traveller& t) HWY_ATTR { // false: no ray is left
        if (left == 0) return false;
        t.ray = static_cast<unsigned>(__builtin_ctz(left));
        left &= left - 1;
        t.waiting = 0;
        t.next = {0, run.begin[t.ray]};
        return true;
    };
    for (; active < kInFlight; ++active) {
        travellers[active].stack = stacks[active].children;
        if (!board(travellers[active])) break;
    }
    while (active != 0)
        for (unsigned i = 0; i < active;) {
            Traveller& t = travellers[i];
            if (step<kAnyHit>(mesh, run, t, best)) {
                fetch(mesh, t.next.code);
                ++i;
            } else if (!board(t)) {
                std::swap(t, travellers[--active]); // each keeps its own stack
            }
        }
}

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
