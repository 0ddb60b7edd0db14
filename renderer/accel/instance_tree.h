// InstanceTree: the upper of the two levels: every object of a scene, found by its box in the world.
//
// Frame      the world, in double.
// Ties       the least (t, instance, primitive) wins, whatever the order of the tree.
// Threads    immutable; rays may be traced from any number of threads.
// Cost       one instance alone is asked directly: the level costs nothing where a scene does not need it. A list,
//            for measuring, asks every instance.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/accel/instance.h"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace renderer {

class InstanceTree {
public:
    // Instances keep their numbers; those with nothing to hit are never found.
    InstanceTree(std::vector<Instance> instances, BvhSplit split, ThreadPool& pool);
    // No tree: every instance in turn; `boxes_first`: only those whose box the ray meets.
    static InstanceTree list(std::vector<Instance> instances, bool boxes_first);

    std::optional<SceneHit> closest_hit(const Ray& ray, RayKind kind = RayKind::other) const;
    bool any_hit(const Ray& ray, RayKind kind = RayKind::other) const;
    // The same for a run of at most kMostRays rays, best of such as run alike: bit i of the result is set where
    // ray i hit, and hits[i] says where.
    std::uint64_t
    closest_hits(std::span<const Ray> rays, std::span<SceneHit> hits, RayKind kind = RayKind::other) const;
    std::uint64_t any_hits(std::span<const Ray> rays, RayKind kind = RayKind::other) const;
    static constexpr unsigned kMostRays = Instance::kMostRays;
    // The same answer from every instance in turn: for tests and for measuring.
    std::optional<SceneHit> closest_hit_brute_force(const Ray& ray, RayKind kind = RayKind::other) const;

    std::span<const Instance> instances() const { return instances_; }
    const Bounds3d& bounds() const { return bounds_; } // empty where nothing can be hit
    std::uint64_t size_bytes() const
    {
        return bvh_.size_bytes() + instances_.capacity() * sizeof(Instance) +
               listed_.capacity() * sizeof(Listed);
    }

private:
    struct Best;
    struct Listed {
        std::uint32_t number;
        Bounds3d box;
    };
    template <bool kAnyHit>
    class RunWalk;
    explicit InstanceTree(std::vector<Instance> instances) : instances_(std::move(instances)) {}
    // Calls ask(instance) until it returns true, for those in the list that the ray may hit before `end`.
    template <typename Ask>
    void ask_listed(const Ray& ray, const double& end, Ask&& ask) const;
    void consider(const Ray& ray, RayKind kind, std::uint32_t number, Best& best) const;
    SceneHit resolve(const Ray& ray, const Best& best) const; // one that was found

    std::vector<Instance> instances_;
    Bvh<double> bvh_;            // `order` holds instance numbers
    std::vector<Listed> listed_; // instead of the tree
    bool boxes_first_ = false;
    Bounds3d bounds_;
};

} // namespace renderer
