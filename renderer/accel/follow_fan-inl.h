// Fans of rays through a mesh: one walk for all of them. Included by mesh_kernels.cpp, once a target.
#if defined(HELIOGRAPH_FOLLOW_FAN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef HELIOGRAPH_FOLLOW_FAN_INL
#undef HELIOGRAPH_FOLLOW_FAN_INL
#else
#define HELIOGRAPH_FOLLOW_FAN_INL
#endif

#include "renderer/accel/fan_leaf-inl.h"
#include "renderer/accel/fan_sides-inl.h"
#include "renderer/accel/occluders.h"
#include "renderer/accel/settle_fan-inl.h"

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

template <bool kAnyHit>
class FanWalk {
public:
    FanWalk(const MeshView& mesh, RayFan& fan, const Ray* rays, MeshHit* best)
        : mesh_(mesh), fan_(fan), found_(mesh, fan, rays, best)
    {
    }

    // Too many leaves met the fan: of rays that have not hit nothing is known, nor of any whose nearest hit was
    // asked for.
    HWY_INLINE bool gave_up() const { return leaves_ > fan_.most_leaves; }
    // Or too few rays were left to go on together.
    HWY_INLINE bool has_left_some() const { return gave_up() || left_few_; }
    // Enough of them to tell whether the walk paid.
    HWY_INLINE bool met_many() const { return leaves_ >= fan_.most_leaves / 4; }

    // Bit i: ray i hit.
    HWY_INLINE std::uint64_t walk()
    {
        if constexpr (kAnyHit)
            return walk_any();
        else
            return walk_nearest();
    }

private:
    static constexpr unsigned kAllGroups = (1u << RayFan::kGroups) - 1;
    static constexpr unsigned kTooFew = 4; // of rays of which any hit will do, in many leaves

    // Nearest first, for the ends that hits draw in.
    HWY_INLINE std::uint64_t walk_nearest()
    {
        struct Waiting {
            std::uint32_t code;
            float entry;
            unsigned groups;
        };
        const FanSides sides(fan_);
        Waiting stack[kMostWaiting];
        unsigned waiting = 0;
        Waiting next{0, sides.begin(), kAllGroups};
        Entered entered;
        end_ = farthest_end();
        for (;;) {
            if ((next.code & ChildCode::kLeaf) != 0) {
                if (++leaves_ > fan_.most_leaves) return 0;
                visit_leaf(next.code, next.groups);
            } else {
                const WideNode& node = mesh_.nodes[next.code];
                sides.enter_children(node, end_, entered);
                const unsigned base = waiting;
                for (unsigned hits = entered.children; hits != 0; hits &= hits - 1) {
                    const auto i = static_cast<unsigned>(__builtin_ctz(hits));
                    const unsigned groups =
                        (node.child[i] & ChildCode::kLeaf) != 0 ? sides.groups_entering(node, i) : kAllGroups;
                    if (groups == 0) { // it counts: among small triangles there may be no others
                        if (++leaves_ > fan_.most_leaves) return 0;
                        continue;
                    }
                    const Waiting child{node.child[i], entered.entries[i], groups};
                    fetch(child.code);
                    unsigned at = waiting++;
                    for (; at > base && stack[at - 1].entry < child.entry; --at)
                        stack[at] = stack[at - 1];
                    stack[at] = child;
                }
            }
            do {
                if (waiting == 0) return found_.settle();
                next = stack[--waiting];
            } while (next.entry > end_);
        }
    }

    // Any order will do: what hid all of the last fan first, then the leaves of a node at once, its inner children later.
    HWY_INLINE std::uint64_t walk_any()
    {
        const FanSides sides(fan_);
        std::uint32_t nodes[kMostWaiting];
        unsigned waiting = 0;
        std::uint32_t next = 0;
        Entered entered;
        unsigned groups[WideNode::kChildren]; // that enter a leaf
        end_ = farthest_end();
        const Occluders known = last_occluders().take(mesh_.nodes, fan_);
        for (unsigned i = 0; i < known.count; ++i) {
            // They may be of a mesh that was here before: any leaf of this one will do.
            if (const std::uint32_t code = known.leaves[i];
                (code & ChildCode::kNumber) + ((code & ChildCode::kTwoBlocks) != 0 ? 2 : 1) <= mesh_.blocks)
                visit_leaf(code, kAllGroups);
            if (end_ < 0) return settle_hidden();
        }
        for (;;) {
            const WideNode& node = mesh_.nodes[next];
            sides.enter_children(node, end_, entered);
            const unsigned leaf_bits = leaves_of(node);
            for (unsigned hits = entered.children & ~leaf_bits; hits != 0; hits &= hits - 1) {
                const std::uint32_t code = node.child[__builtin_ctz(hits)];
                fetch(code);
                nodes[waiting++] = code;
            }
            unsigned some = 0;
            for (unsigned hits = entered.children & leaf_bits; hits != 0; hits &= hits - 1) {
                const auto i = static_cast<unsigned>(__builtin_ctz(hits));
                // Shadow rays start at all depths: what all together meet is often met by none.
                groups[i] = sides.groups_entering(node, i);
                if (groups[i] == 0) continue;
                fetch(node.child[i]);
                some |= 1u << i;
            }
            for (; some != 0; some &= some - 1) {
                if (++leaves_ > fan_.most_leaves) return found_.settle();
                const auto i = static_cast<unsigned>(__builtin_ctz(some));
                visit_leaf(node.child[i], groups[i]);
                if (end_ < 0) return settle_hidden();
                if (leaves_ > fan_.most_leaves / 3 && found_.missing() <= kTooFew) {
                    left_few_ = true;
                    return found_.settle();
                }
            }
            if (waiting == 0) return found_.settle();
            next = nodes[--waiting];
        }
    }

    // All rays have hit for certain.
    HWY_INLINE std::uint64_t settle_hidden()
    {
        last_occluders().put(mesh_.nodes, fan_, hiding_);
        return found_.settle();
    }

    // Children that are leaves, by their codes' sign.
    static HWY_INLINE unsigned leaves_of(const WideNode& node)
    {
        static_assert(ChildCode::kLeaf == 1u << 31);
        const hn::Rebind<std::int32_t, Eight> d;
        unsigned bits = 0;
        for (std::size_t lane = 0; lane < WideNode::kChildren; lane += hn::MaxLanes(d))
            bits |= bits_of(d,
                            hn::Lt(hn::Load(d, reinterpret_cast<const std::int32_t*>(node.child) + lane),
                                   hn::Zero(d)))
                    << lane;
        return bits;
    }

    // What is to be visited comes while others are looked at.
    HWY_INLINE void fetch(std::uint32_t code) const
    {
        constexpr std::size_t kLine = 64;
        const bool leaf = (code & ChildCode::kLeaf) != 0;
        const char* const of_leaf = reinterpret_cast<const char*>(mesh_.leaves + (code & ChildCode::kNumber));
        const char* const of_node = reinterpret_cast<const char*>(mesh_.nodes + code);
        const char* const bytes = leaf ? of_leaf : of_node;
        const std::size_t size = leaf ? 2 * sizeof(TriangleBlock) : sizeof(WideNode);
        for (std::size_t at = 0; at < size; at += kLine)
            __builtin_prefetch(bytes + at);
    }

    HWY_INLINE float farthest_end() const
    {
        const Group f;
        auto most = hn::Load(f, fan_.group_end);
        for (unsigned i = kGroupLanes; i < RayFan::kGroups; i += kGroupLanes)
            most = hn::Max(most, hn::Load(f, fan_.group_end + i));
        return hn::GetLane(hn::MaxOfLanes(f, most));
    }

    HWY_INLINE void visit_leaf(std::uint32_t code, unsigned groups)
    {
        const std::uint32_t first = code & ChildCode::kNumber;
        FanLeaf seen;
        LeafViewer<kAnyHit>(fan_, end_)
            .see(mesh_.leaves + first, (code & ChildCode::kTwoBlocks) != 0 ? 2 : 1, seen);
        bool drawn = false;
        for (unsigned left = seen.meeting & ~seen.faces; left != 0; left &= left - 1) {
            const auto lane = static_cast<unsigned>(__builtin_ctz(left));
            for (unsigned near = groups_near(seen, lane) & groups; near != 0; near &= near - 1)
                drawn = ask_group(static_cast<unsigned>(__builtin_ctz(near)),
                                  first * TriangleBlock::kLanes + lane) ||
                        drawn;
        }
        if (const unsigned certain = seen.meeting & seen.faces; certain != 0)
            for (std::uint64_t pairs = pairs_meeting(seen, certain, groups); pairs != 0; pairs &= pairs - 1) {
                const auto pair = static_cast<unsigned>(__builtin_ctzll(pairs));
                const unsigned lane = pair % FanLeaf::kLanes;
                drawn =
                    test_group(seen, lane, pair / FanLeaf::kLanes, first * TriangleBlock::kLanes + lane) ||
                    drawn;
            }
        if (!drawn) return;
        end_ = farthest_end();
        if constexpr (kAnyHit) hiding_.add(code);
    }

    // Bit group * kLanes + lane: some ray of the group may hit that triangle.
    HWY_INLINE std::uint64_t pairs_meeting(const FanLeaf& seen, unsigned certain, unsigned groups) const
    {
        static_assert(FanLeaf::kLanes * RayFan::kGroups == 64);
        const Eight d;
        using V = hn::Vec<Eight>;
        constexpr unsigned kAtOnce = hn::MaxLanes(d);
        std::uint64_t pairs = 0;
        for (unsigned i = 0; i < FanLeaf::kLanes; i += kAtOnce) {
            if ((certain >> i & ((1u << kAtOnce) - 1)) == 0) continue;
            const auto load = [&](const float* of) HWY_ATTR { return hn::Load(d, of + i); };
            const V nearest = load(seen.nearest);
            const V least_x = load(seen.least_x), most_x = load(seen.most_x);
            const V least_y = load(seen.least_y), most_y = load(seen.most_y);
            const V zero = hn::Zero(d);
            // An edge function is largest in one corner of a group's bounds.
            V up[3][2], down[3][2], at[3];
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t axis = 0; axis < 2; ++axis) {
                    const V e = load(seen.edge[k][axis]);
                    up[k][axis] = hn::Max(e, zero);
                    down[k][axis] = hn::Min(e, zero);
                }
                at[k] = load(seen.edge[k][2]);
            }
            for (unsigned some = groups; some != 0; some &= some - 1) {
                const auto g = static_cast<unsigned>(__builtin_ctz(some));
                const V low_x = hn::Set(d, fan_.least_x[g]), high_x = hn::Set(d, fan_.most_x[g]);
                const V low_y = hn::Set(d, fan_.least_y[g]), high_y = hn::Set(d, fan_.most_y[g]);
                auto out = hn::Lt(hn::Set(d, fan_.group_end[g]), nearest);
                out = hn::Or(out, hn::Or(hn::Lt(high_x, least_x), hn::Lt(most_x, low_x)));
                out = hn::Or(out, hn::Or(hn::Lt(high_y, least_y), hn::Lt(most_y, low_y)));
                for (std::size_t k = 0; k < 3; ++k) {
                    const V most = hn::MulAdd(
                        up[k][0],
                        high_x,
                        hn::MulAdd(down[k][0],
                                   low_x,
                                   hn::MulAdd(up[k][1], high_y, hn::MulAdd(down[k][1], low_y, at[k]))));
                    out = hn::Or(out, hn::Lt(most, zero));
                }
                pairs |= std::uint64_t{~bits_of(d, out) & ((1u << kAtOnce) - 1)} << (g * FanLeaf::kLanes + i);
            }
        }
        return pairs & certain * std::uint64_t{0x0101010101010101};
    }

    // Groups that come near the triangle, whichever side of it they see.
    HWY_INLINE unsigned groups_near(const FanLeaf& seen, unsigned lane) const
    {
        const Group f;
        unsigned groups = 0;
        for (unsigned i = 0; i < RayFan::kGroups; i += kGroupLanes) {
            const auto apart = [&](const float* least, const float* most, float from, float to) HWY_ATTR {
                return hn::Or(hn::Lt(hn::Load(f, most + i), hn::Set(f, from)),
                              hn::Lt(hn::Set(f, to), hn::Load(f, least + i)));
            };
            auto out = apart(fan_.group_begin, fan_.group_end, seen.nearest[lane], seen.farthest[lane]);
            out = hn::Or(out, apart(fan_.least_x, fan_.most_x, seen.least_x[lane], seen.most_x[lane]));
            out = hn::Or(out, apart(fan_.least_y, fan_.most_y, seen.least_y[lane], seen.most_y[lane]));
            groups |= (~bits_of(f, out) & ((1u << kGroupLanes) - 1)) << i;
        }
        return groups;
    }

    // A triangle whose plane goes through the apex, as far as one can tell.
    HWY_INLINE bool ask_group(unsigned group, std::uint32_t triangle)
    {
        const bool drawn = found_.ask(group * RayFan::kGroup, (1u << RayFan::kGroup) - 1, triangle);
        if (drawn) found_.bound_group(group);
        return drawn;
    }

    // The triangle against the rays of a group. True where a ray's end was drawn in.
    HWY_INLINE bool test_group(const FanLeaf& seen, unsigned lane, unsigned group, std::uint32_t triangle)
    {
        const Group f;
        bool drawn = false;
        for (unsigned i = 0; i < RayFan::kGroup; i += kGroupLanes) {
            const unsigned ray = group * RayFan::kGroup + i;
            const auto sx = hn::Load(f, fan_.slope_x + ray), sy = hn::Load(f, fan_.slope_y + ray);
            const auto along = [&](const float(&n)[3][FanLeaf::kLanes]) HWY_ATTR {
                return hn::MulAdd(hn::Set(f, n[0][lane]),
                                  sx,
                                  hn::MulAdd(hn::Set(f, n[1][lane]), sy, hn::Set(f, n[2][lane])));
            };
            const auto inside =
                hn::Min(along(seen.edge[0]), hn::Min(along(seen.edge[1]), along(seen.edge[2])));
            const auto most_det = along(seen.whole);
            const auto least = hn::Set(f, seen.least_volume[lane]);
            // No hit: beside the triangle, or the plane is met too late. Rays of a fan begin at its apex, or nearly so:
            // what is too early has been left out by `all_begin`, or is told by the exact test.
            const auto out = hn::Or(hn::Lt(inside, hn::Zero(f)),
                                    hn::Lt(hn::Mul(hn::Load(f, fan_.end + ray), most_det), least));
            const unsigned rays = ~bits_of(f, out) & ((1u << kGroupLanes) - 1);
            if (rays == 0) continue;
            // A hit for certain, and nearer than what is known: the bounds of its depth, quotients of these, say so.
            const auto least_det = hn::Sub(most_det, hn::Set(f, seen.whole_slack[lane])),
                       most = hn::Set(f, seen.most_volume[lane]);
            const auto less = hn::Mul(least, hn::Set(f, 1 - 0x1p-21f)),
                       more = hn::Mul(most, hn::Set(f, 1 + 0x1p-21f));
            const auto hit = hn::And(
                hn::And(hn::Lt(hn::Set(f, seen.edge_slack[lane]), inside), hn::Lt(hn::Zero(f), least_det)),
                hn::And(hn::Lt(hn::Mul(hn::Load(f, fan_.after + ray), most_det), less),
                        hn::Lt(more, hn::Mul(hn::Load(f, fan_.before + ray), least_det))));
            const unsigned hits = bits_of(f, hit) & rays;
            if (hits != 0) {
                if constexpr (kAnyHit) {
                    found_.hit(ray, hits);
                    const auto none = hn::Set(f, -std::numeric_limits<float>::infinity());
                    hn::Store(hn::IfThenElse(hit, none, hn::Load(f, fan_.end + ray)), f, fan_.end + ray);
                } else {
                    const auto nearest = hn::Mul(hn::Div(least, most_det), hn::Set(f, 1 - 0x1p-21f));
                    const auto farthest = hn::Mul(hn::Div(most, least_det), hn::Set(f, 1 + 0x1p-21f));
                    found_.prefer(ray, hn::And(hit, hn::Not(out)), hits, triangle);
                    hn::Store(hn::IfThenElse(hit, farthest, hn::Load(f, fan_.end + ray)), f, fan_.end + ray);
                    hn::Store(
                        hn::IfThenElse(hit, nearest, hn::Load(f, fan_.before + ray)), f, fan_.before + ray);
                }
                drawn = true;
            }
            if (const unsigned unclear = rays & ~hits; unclear != 0)
                drawn = found_.ask(ray, unclear, triangle) || drawn;
        }
        if (drawn) found_.bound_group(group);
        return drawn;
    }

    const MeshView& mesh_;
    RayFan& fan_;
    FanFindings<kAnyHit> found_;
    float end_ = 0;
    unsigned leaves_ = 0;
    bool left_few_ = false;
    Occluders hiding_;
};

} // namespace
} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif // per-target include guard
