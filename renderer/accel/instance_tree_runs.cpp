// InstanceTree's answers for runs of rays.
#include "renderer/accel/box_rays.h"
#include "renderer/accel/instance_tree.h"
#include "renderer/math/uninitialized.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace renderer {

void InstanceTree::resolve(std::span<const Ray> rays,
                           std::uint32_t asked,
                           const Instance::Candidate* candidates,
                           std::uint64_t which,
                           std::span<SceneHit> hits) const
{
    const bool is_of_joined = asked >= instances_.size();
    if (!is_of_joined) instances_[asked].resolve(rays, candidates, which, hits.data());
    for (; which != 0; which &= which - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(which));
        if (is_of_joined)
            hits[i] = joined_->resolve(candidates[i], instances_);
        else
            hits[i].instance = asked;
    }
}

// A run of rays on its way down the tree: instances are asked with all the rays that reach their boxes.
template <bool kAnyHit>
class InstanceTree::RunWalk {
public:
    RunWalk(const InstanceTree& tree, std::span<const Ray> rays, RayKind kind)
        : tree_(tree), rays_(rays), kind_(kind), boxes_(rays, tree.bounds_)
    {
    }

    void walk()
    {
        struct Waiting {
            const BvhNode<double>* node;
            std::uint64_t rays;
            double entry;
        };
        if (tree_.bvh_.empty()) return walk_list();
        const bool many = tree_.bvh_.order.size() >= kMany;
        if (many && are_to_part()) return follow_each(boxes_.rays, &tree_.bvh_.root);
        Waiting stack[2 * kMaxBvhDepth];
        unsigned waiting = 0;
        const auto enter = [&](const BvhNode<double>& node) {
            Waiting next{&node, 0, 0};
            next.rays = kernels_.enter_box(boxes_, node.lower, node.upper, next.entry);
            return next;
        };
        if (const Waiting root = enter(tree_.bvh_.root); root.rays != 0) stack[waiting++] = root;
        while (waiting != 0) {
            const Waiting next = stack[--waiting];
            if (next.node->count != 0) {
                ask_leaf(*next.node, next.rays);
                if (kAnyHit && found_ == boxes_.rays) return;
                continue;
            }
            if (many && std::popcount(next.rays) <= kFew) {
                follow_each(next.rays, next.node);
                if (kAnyHit && found_ == boxes_.rays) return;
                continue;
            }
            const BvhPair<double>& pair = tree_.bvh_.pairs[next.node->first];
            Waiting one = enter(pair.child[0]), other = enter(pair.child[1]);
            if (other.entry < one.entry) std::swap(one, other); // the nearer goes first
            if (other.rays != 0) stack[waiting++] = other;
            if (one.rays != 0) stack[waiting++] = one;
        }
    }

    std::uint64_t found() const { return found_; }

    // Of those that were found, instance by instance.
    void resolve(std::span<SceneHit> hits)
    {
        for (std::uint64_t left = found_; left != 0;) {
            const std::uint32_t asked = asked_[std::countr_zero(left)];
            std::uint64_t same = 0;
            for (std::uint64_t others = left; others != 0; others &= others - 1) {
                const int i = std::countr_zero(others);
                same |= std::uint64_t{asked_[i] == asked} << i;
            }
            tree_.resolve(rays_, asked, candidates_.data(), same, hits);
            left &= ~same;
        }
    }

private:
    void walk_list()
    {
        for (const Listed& one : tree_.listed_) {
            double entry = 0;
            ask(one.number,
                tree_.boxes_first_ ? kernels_.enter_box(boxes_, one.box.lower, one.box.upper, entry)
                                   : boxes_.rays);
            if (kAnyHit && found_ == boxes_.rays) return;
        }
    }

    // Among so many instances rays part before they arrive: those that do not run alike are quicker one by one. Among
    // fewer, what counts is that a mesh gets many of them at once.
    static constexpr std::size_t kMany = 64;
    static constexpr int kFew = 5; // that part from the others on the way

    bool are_to_part() const
    {
        std::uint64_t negative[3]{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (unsigned i = 0; i < boxes_.lanes; ++i)
                negative[axis] |= std::uint64_t{std::signbit(boxes_.near_inverse[axis][i])} << i;
        return std::any_of(negative, negative + 3, [&](std::uint64_t rays) {
            return (rays & boxes_.rays) != 0 && (rays & boxes_.rays) != boxes_.rays;
        });
    }
    void follow_each(std::uint64_t rays, const BvhNode<double>* from)
    {
        for (; rays != 0; rays &= rays - 1)
            follow_one(static_cast<unsigned>(std::countr_zero(rays)), from);
    }

    void ask_leaf(const BvhNode<double>& leaf, std::uint64_t rays)
    {
        for (std::uint32_t i = 0; i < leaf.count; ++i)
            ask(tree_.bvh_.order[leaf.first + i], rays);
    }

    // One ray through what is below a node, nearest boxes first.
    void follow_one(unsigned ray, const BvhNode<double>* node)
    {
        struct Waiting {
            const BvhNode<double>* node;
            double entry;
        };
        const SlabRay<double> slabs = boxes_.one(ray);
        const double begin = boxes_.begin[ray];
        const double& end = boxes_.end[ray]; // drawn in by hits
        Waiting stack[kMaxBvhDepth];
        unsigned waiting = 0;
        double entry[2]{}, exit{};
        for (;;) {
            if (node->count == 0) {
                const BvhPair<double>& pair = tree_.bvh_.pairs[node->first];
                bool met[2];
                for (std::size_t i = 0; i < 2; ++i)
                    met[i] =
                        slabs.meets(pair.child[i].lower, pair.child[i].upper, begin, end, entry[i], exit);
                const std::size_t nearer = met[1] && (!met[0] || entry[1] < entry[0]) ? 1 : 0;
                if (met[1 - nearer]) stack[waiting++] = {&pair.child[1 - nearer], entry[1 - nearer]};
                if (met[nearer]) {
                    node = &pair.child[nearer];
                    continue;
                }
            } else {
                ask_leaf(*node, std::uint64_t{1} << ray);
                if (kAnyHit && (found_ >> ray & 1) != 0) return;
            }
            do {
                if (waiting == 0) return;
                --waiting;
            } while (stack[waiting].entry > end);
            node = stack[waiting].node;
        }
    }

    // `rays` may be done by now, all the same: what they find is no better.
    void ask(std::uint32_t number, std::uint64_t rays)
    {
        const Instance& instance = tree_.asked(number);
        if (kAnyHit) rays &= ~found_;
        if (rays == 0 || !instance.visible_to(kind_)) return;
        Uninitialized<Ray, kMostRays> asking;
        unsigned from[kMostRays];
        unsigned count = 0;
        for (; rays != 0; rays &= rays - 1) {
            const auto ray = static_cast<unsigned>(__builtin_ctzll(rays));
            asking[count] = rays_[ray];
            if ((found_ >> ray & 1) != 0) asking[count].t_max = just_past(boxes_.end[ray], rays_[ray].t_max);
            from[count++] = ray;
        }
        if (kAnyHit) {
            for (std::uint64_t met = instance.any_hits(asking.first(count)); met != 0; met &= met - 1) {
                const unsigned ray = from[__builtin_ctzll(met)];
                found_ |= std::uint64_t{1} << ray;
                boxes_.end[ray] = -std::numeric_limits<double>::infinity();
            }
            return;
        }
        Uninitialized<Instance::Candidate, kMostRays> hits;
        for (std::uint64_t met = instance.closest_hits(asking.first(count), hits.data()); met != 0;
             met &= met - 1) {
            const auto i = static_cast<unsigned>(__builtin_ctzll(met));
            const unsigned ray = from[i];
            if ((found_ >> ray & 1) != 0 && !tree_.is_better(number, hits[i], asked_[ray], candidates_[ray]))
                continue;
            found_ |= std::uint64_t{1} << ray;
            asked_[ray] = number;
            candidates_[ray] = hits[i];
            boxes_.end[ray] = hits[i].t;
        }
    }

    const InstanceTree& tree_;
    std::span<const Ray> rays_;
    RayKind kind_;
    const MeshKernels& kernels_ = mesh_kernels();
    BoxRays boxes_;
    std::uint64_t found_ = 0;
    std::uint32_t asked_[kMostRays]; // of those found: in which, and what
    Uninitialized<Instance::Candidate, kMostRays> candidates_;
};

std::uint64_t
InstanceTree::closest_hits(std::span<const Ray> rays, std::span<SceneHit> hits, RayKind kind) const
{
    if (bvh_.order.size() == 1) {
        const std::uint32_t number = bvh_.order[0];
        const Instance& only = asked(number);
        if (!only.visible_to(kind)) return 0;
        Uninitialized<Instance::Candidate, kMostRays> found;
        const std::uint64_t met = only.closest_hits(rays, found.data());
        resolve(rays, number, found.data(), met, hits);
        return met;
    }
    RunWalk<false> run(*this, rays, kind);
    run.walk();
    run.resolve(hits);
    return run.found();
}

std::uint64_t InstanceTree::any_hits(std::span<const Ray> rays, RayKind kind) const
{
    if (bvh_.order.size() == 1) {
        const Instance& only = asked(bvh_.order[0]);
        return only.visible_to(kind) ? only.any_hits(rays) : 0;
    }
    RunWalk<true> run(*this, rays, kind);
    run.walk();
    return run.found();
}

} // namespace renderer
