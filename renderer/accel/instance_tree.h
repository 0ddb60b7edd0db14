// InstanceTree: the upper of the two levels: every object of a scene, found by its box in the world.
//
// Frame      the world, in double.
// Ties       the least (t, instance, primitive) wins, whatever the order of the tree.
// Threads    immutable; rays may be traced from any number of threads.
// Joined     instances whose meshes were put together (joined_mesh.h) are met there alone, and told apart again.
// Cost       one instance alone is asked directly: the level costs nothing where a scene does not need it. A list,
//            for measuring, asks every instance.
// Refitted   a tree of an earlier frame of an animation, where that, by what is foretold, takes less time in all than building
//            anew: see bvh_topology.h.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/accel/bvh_topology_cache.h"
#include "renderer/accel/instance.h"
#include "renderer/accel/joined_mesh.h"
#include "renderer/description/report.h"

#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace renderer {

// Where earlier frames of an animation left their trees, and this one leaves its own.
struct EarlierFrames {
    BvhTopologyCache* trees = nullptr; // or none
    double rays = 0;                   // to be traced in this one, about
};

class InstanceTree {
public:
    // Instances keep their numbers; those with nothing to hit are never found. Where `stop` was requested, what is made
    // means nothing.
    InstanceTree(std::vector<Instance> instances,
                 BvhSplit split,
                 ThreadPool& pool,
                 std::optional<JoinedMesh> joined = std::nullopt,
                 const EarlierFrames& earlier = {},
                 const std::stop_token& stop = {});
    // No tree: every instance in turn; `boxes_first`: only those whose box the ray meets.
    static InstanceTree
    list(std::vector<Instance> instances, bool boxes_first, std::optional<JoinedMesh> joined = std::nullopt);

    std::optional<SceneHit> closest_hit(const Ray& ray, RayKind kind = RayKind::other) const;
    bool any_hit(const Ray& ray, RayKind kind = RayKind::other) const;
    // The same for a run of at most kMostRays rays, best of such as run alike: bit i of the result is set where
    // ray i hit, and hits[i] says where.
    std::uint64_t
    closest_hits(std::span<const Ray> rays, std::span<SceneHit> hits, RayKind kind = RayKind::other) const;
    std::uint64_t any_hits(std::span<const Ray> rays, RayKind kind = RayKind::other) const;
    static constexpr unsigned kMostRays = Instance::kMostRays;
    // The same answer from every instance, and what is joined, in turn: for tests and for measuring.
    std::optional<SceneHit> closest_hit_brute_force(const Ray& ray, RayKind kind = RayKind::other) const;

    std::span<const Instance> instances() const { return instances_; }
    const Bounds3d& bounds() const { return bounds_; } // empty where nothing can be hit
    UpperLevel upper_level() const { return upper_level_; }
    std::uint64_t size_bytes() const
    {
        return bvh_.size_bytes() + instances_.capacity() * sizeof(Instance) +
               listed_.capacity() * sizeof(Listed) + (joined_ ? joined_->size_bytes() : 0);
    }

private:
    struct Best;
    struct Listed {
        std::uint32_t number;
        Bounds3d box;
    };
    template <bool kAnyHit>
    class RunWalk;
    InstanceTree(std::vector<Instance> instances, std::optional<JoinedMesh> joined);
    // What is asked: instances by their numbers, and after the last of them what is joined of them.
    std::uint32_t asked_count() const
    {
        return static_cast<std::uint32_t>(instances_.size() + (joined_ ? 1 : 0));
    }
    const Instance& asked(std::uint32_t number) const
    {
        return number < instances_.size() ? instances_[number] : joined_->instance();
    }
    Bounds3d box_to_meet(std::uint32_t number) const; // empty: nothing is met there
    // Calls ask(instance) until it returns true, for those in the list that the ray may hit before `end`.
    template <typename Ask>
    void ask_listed(const Ray& ray, const double& end, Ask&& ask) const;
    bool is_better(std::uint32_t number,
                   const Instance::Candidate& hit,
                   std::uint32_t best_number,
                   const Instance::Candidate& best) const;
    void consider(const Ray& ray, RayKind kind, std::uint32_t number, Best& best) const;
    SceneHit resolve(const Ray& ray, const Best& best) const; // one that was found
    void resolve(std::span<const Ray> rays,
                 std::uint32_t asked, // that all of them were found in
                 const Instance::Candidate* candidates,
                 std::uint64_t which,
                 std::span<SceneHit> hits) const;

    std::vector<Instance> instances_;
    std::optional<JoinedMesh> joined_;
    std::vector<std::uint8_t> is_joined_; // by instance; or none
    Bvh<double> bvh_;                     // `order` holds instance numbers
    std::vector<Listed> listed_;          // instead of the tree
    bool boxes_first_ = false;
    UpperLevel upper_level_ = UpperLevel::none;
    Bounds3d bounds_;
};

} // namespace renderer
