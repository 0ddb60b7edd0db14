// Packets of rays through a mesh: one walk for all of them. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_FOLLOW_TOGETHER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_FOLLOW_TOGETHER_INL
#undef HELIOGRAPH_FOLLOW_TOGETHER_INL
#else
#define HELIOGRAPH_FOLLOW_TOGETHER_INL
#endif

#include "renderer/accel/exact_test.h"
#include "renderer/accel/prepare_run-inl.h"

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// What all rays of a run that is followed together lie within: along each axis a box is entered no earlier than
// the lesser of (plane - near_origin) * least_scale and ... * most_scale, and left no later than the greater of
// (plane - far_origin) * least_scale and ... * most_scale.
struct Beam {
    float near_origin[3], far_origin[3], least_scale[3], most_scale[3];
    float begin = 0;
    std::uint8_t near_row[3];
};

HWY_INLINE float least_of(const RayRun::Lanes<float>& values)
{
    const Floats f;
    auto least = hn::Load(f, values);
    for (std::size_t i = hn::MaxLanes(f); i < RayRun::kRays; i += hn::MaxLanes(f))
        least = hn::Min(least, hn::Load(f, values + i));
    return hn::GetLane(hn::MinOfLanes(f, least));
}
HWY_INLINE float most_of(const RayRun::Lanes<float>& values)
{
    const Floats f;
    auto most = hn::Load(f, values);
    for (std::size_t i = hn::MaxLanes(f); i < RayRun::kRays; i += hn::MaxLanes(f))
        most = hn::Max(most, hn::Load(f, values + i));
    return hn::GetLane(hn::MaxOfLanes(f, most));
}

HWY_INLINE Beam beam_of(const RayRun& run)
{
    Beam beam;
    const float lateral = most_of(run.lateral);
    const auto any = static_cast<unsigned>(__builtin_ctz(run.rays));
    beam.begin = -4 * lateral;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        beam.near_row[axis] = run.near_row[axis][any];
        const bool negative = (beam.near_row[axis] & 1) != 0;
        const float least = least_of(run.from[axis]), most = most_of(run.from[axis]);
        beam.near_origin[axis] = negative ? least - 2 * lateral : most + 2 * lateral;
        beam.far_origin[axis] = negative ? most + 2 * lateral : least - 2 * lateral;
        // From the slowest near factor to the fastest far one, and the roundings of this test itself.
        const float low = negative ? most_of(run.near_scale[axis]) : least_of(run.near_scale[axis]);
        const float high = negative ? least_of(run.far_scale[axis]) : most_of(run.far_scale[axis]);
        beam.least_scale[axis] = low * (1 - gamma<float>(6));
        beam.most_scale[axis] = high * (1 + gamma<float>(6));
    }
    return beam;
}

// Children that some ray of the beam may enter.
HWY_INLINE void enter_children(const WideNode& node, const Beam& p, float end, Entered& out)
{
    const Eight d;
    out.children = 0;
    for (std::size_t lane = 0; lane < WideNode::kChildren; lane += hn::MaxLanes(d)) {
        auto entry = hn::Set(d, p.begin), exit = hn::Set(d, end);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto least = hn::Set(d, p.least_scale[axis]), most = hn::Set(d, p.most_scale[axis]);
            const auto to_near =
                hn::Sub(hn::Load(d, node.planes[p.near_row[axis]] + lane), hn::Set(d, p.near_origin[axis]));
            const auto to_far = hn::Sub(hn::Load(d, node.planes[p.near_row[axis] ^ 1] + lane),
                                        hn::Set(d, p.far_origin[axis]));
            entry = hn::Max(entry, hn::Min(hn::Mul(to_near, least), hn::Mul(to_near, most)));
            exit = hn::Min(exit, hn::Max(hn::Mul(to_far, least), hn::Mul(to_far, most)));
        }
        hn::Store(entry, d, out.entries + lane);
        out.children |= bits_of(d, hn::Le(entry, exit)) << lane;
    }
}

// Rays that may enter this one box.
HWY_INLINE unsigned rays_entering(const RayRun& p, const Beam& beam, const WideNode& node, unsigned child)
{
    const Floats d;
    unsigned rays = 0;
    for (std::size_t i = 0; i < RayRun::kRays; i += hn::MaxLanes(d)) {
        auto entry = hn::Set(d, beam.begin), exit = hn::Load(d, p.end + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto near_plane = hn::Set(d, node.planes[beam.near_row[axis]][child]);
            const auto far_plane = hn::Set(d, node.planes[beam.near_row[axis] ^ 1][child]);
            entry = hn::Max(entry,
                            hn::MulAdd(near_plane,
                                       hn::Load(d, p.near_scale[axis] + i),
                                       hn::Load(d, p.near_shift[axis] + i)));
            exit = hn::Min(exit,
                           hn::MulAdd(far_plane,
                                      hn::Load(d, p.far_scale[axis] + i),
                                      hn::Load(d, p.far_shift[axis] + i)));
        }
        rays |= bits_of(d, hn::Le(entry, exit)) << i;
    }
    return rays;
}

// may_hit, for one triangle and all rays.
HWY_INLINE unsigned
rays_that_may_hit(const RayRun& p, const Beam& beam, const TriangleBlock& block, unsigned lane)
{
    const auto any = static_cast<unsigned>(__builtin_ctz(p.rays));
    const std::size_t kx = p.kx[any], ky = p.ky[any], kz = p.kz[any];
    const Floats d;
    unsigned rays = 0;
    for (std::size_t i = 0; i < RayRun::kRays; i += hn::MaxLanes(d)) {
        const auto ox = hn::Load(d, p.from[kx] + i), oy = hn::Load(d, p.from[ky] + i),
                   oz = hn::Load(d, p.from[kz] + i);
        const auto shear_x = hn::Load(d, p.shear_x + i), shear_y = hn::Load(d, p.shear_y + i),
                   depth_scale = hn::Load(d, p.depth_scale + i);
        hn::Vec<Floats> x[3], y[3], t[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& corner = block.corners[k];
            const auto depth = hn::Sub(hn::Set(d, corner[kz][lane]), oz);
            x[k] = hn::NegMulAdd(shear_x, depth, hn::Sub(hn::Set(d, corner[kx][lane]), ox));
            y[k] = hn::NegMulAdd(shear_y, depth, hn::Sub(hn::Set(d, corner[ky][lane]), oy));
            t[k] = hn::Mul(depth, depth_scale);
        }
        const auto out = certain_miss(
            d, x, y, t, hn::Load(d, p.lateral + i), hn::Set(d, beam.begin), hn::Load(d, p.end + i));
        rays |= (~bits_of(d, out) & ((1u << hn::MaxLanes(d)) - 1)) << i;
    }
    return rays;
}

template <bool kAnyHit>
class PacketWalk {
public:
    PacketWalk(const MeshView& mesh, RayRun& run, MeshHit* best)
        : mesh_(mesh), p_(run), beam_(beam_of(run)), best_(best)
    {
    }

    HWY_INLINE void walk()
    {
        struct Waiting {
            std::uint32_t node, child; // the child's box is in its node
            float entry;
        };
        Waiting stack[kMostWaiting];
        unsigned waiting = 0;
        Waiting next{0, WideNode::kChildren, beam_.begin}; // the root
        float end = most_of(p_.end);
        Entered entered;
        for (;;) {
            const std::uint32_t code =
                next.child == WideNode::kChildren ? 0 : mesh_.nodes[next.node].child[next.child];
            if ((code & ChildCode::kLeaf) != 0) {
                if (visit_leaf(code, next.node, next.child)) {
                    end = most_of(p_.end);
                    if (kAnyHit && hit_ == p_.rays) return;
                }
            } else {
                const WideNode& node = mesh_.nodes[code];
                enter_children(node, beam_, end, entered);
                const unsigned base = waiting;
                for (unsigned hits = entered.children; hits != 0; hits &= hits - 1) {
                    const auto i = static_cast<unsigned>(__builtin_ctz(hits));
                    const Waiting child{code, i, entered.entries[i]};
                    unsigned at = waiting++;
                    for (; at > base && stack[at - 1].entry < child.entry; --at)
                        stack[at] = stack[at - 1];
                    stack[at] = child;
                }
            }
            do {
                if (waiting == 0) return;
                next = stack[--waiting];
            } while (next.entry > end);
        }
    }

private:
    // True where a ray's end was drawn in.
    HWY_INLINE bool visit_leaf(std::uint32_t code, std::uint32_t node, std::uint32_t child)
    {
        const unsigned active = rays_entering(p_, beam_, mesh_.nodes[node], child);
        if (active == 0) return false;
        bool drawn = false;
        const TriangleBlock* block = mesh_.leaves + (code & ChildCode::kNumber);
        const TriangleBlock* const last = block + ((code & ChildCode::kTwoBlocks) != 0 ? 1 : 0);
        for (; block <= last; ++block)
            for (unsigned lane = 0; lane < TriangleBlock::kLanes; ++lane) {
                if (block->primitive[lane] == TriangleBlock::kNone) break;
                for (unsigned rays = active & rays_that_may_hit(p_, beam_, *block, lane); rays != 0;
                     rays &= rays - 1)
                    drawn = decide(static_cast<unsigned>(__builtin_ctz(rays)), *block, lane) || drawn;
            }
        return drawn;
    }

    HWY_INLINE bool decide(unsigned ray, const TriangleBlock& block, unsigned lane)
    {
        if (!improve_hit(p_.exact(ray), p_.t_min[ray], p_.t_max[ray], mesh_, block, lane, best_[ray]))
            return false;
        hit_ |= 1u << ray;
        p_.end[ray] = kAnyHit ? -std::numeric_limits<float>::infinity()
                              : std::min(p_.end[ray], p_.end_for(best_[ray].t, ray));
        return true;
    }

    const MeshView& mesh_;
    RayRun& p_;
    const Beam beam_;
    MeshHit* best_;
    unsigned hit_ = 0;
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
