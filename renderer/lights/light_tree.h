// LightTree: picks one of many lights for a point, likelier the more it may send there, in logarithmic time.
//
// Units   power in W, strongest channel; any positive number, only ratios count.
// Promise a light of any power that may reach a point is picked with a chance above zero; probability() says the
//         chance that pick() picks by.
// Source  A. Conty Estevez, C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", HPG 2018:
//         nodes with box, power and cone of normals, without its splitting, and without the receiver's normal.
// Threads immutable. Cost: pick and probability O(log n), two nodes a level; building O(n log n); 88 bytes a light.
#pragma once

#include "renderer/math/bounds.h"

#include <cstdint>
#include <span>
#include <vector>

namespace renderer {

// A light as the tree sees it: where it is, what it gives, and around which axis: cos_spread is the cosine of how
// far its normals lean from the axis (-1: every way). It shines a quarter of a turn around each normal.
struct LightBounds {
    Bounds3d box;
    double power = 0;
    Vec3d axis{0, 0, 1};
    double cos_spread = -1;
};

class LightTree {
public:
    LightTree() = default;
    // Lights keep their numbers; those of no power are never picked.
    explicit LightTree(std::span<const LightBounds> lights);

    bool empty() const { return nodes_.empty(); }
    struct Pick {
        std::uint32_t light = 0;
        double probability = 0; // 0: nothing reaches the point
    };
    Pick pick(Vec3d point, double u) const;
    double probability(Vec3d point, std::uint32_t light) const;
    std::uint64_t size_bytes() const
    {
        return nodes_.capacity() * sizeof(Node) + leaf_of_.capacity() * sizeof(std::uint32_t);
    }

private:
    struct Node {
        LightBounds bounds;
        std::uint32_t parent = 0;
        std::uint32_t second_child = 0; // the first follows its parent; 0: a leaf
        std::uint32_t light = 0;        // of a leaf
    };
    static constexpr std::uint32_t kNoLeaf = 0xffffffff;
    std::uint32_t
    build(std::span<std::uint32_t> lights, std::span<const LightBounds> all, std::uint32_t parent);
    double share_of_first(Vec3d point, std::uint32_t node) const;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_; // by light
};

// How much of a light's power may reach a point, relative to others: never below zero, never infinite.
double importance(const LightBounds& light, Vec3d point);

} // namespace renderer
