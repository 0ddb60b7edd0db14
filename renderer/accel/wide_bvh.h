// WideBvh: a tree of boxes, eight children a node, tested at once; made from a binary Bvh<float>.
//
// Layout  224 bytes a node, inner children side by side. A child is an inner node, or a leaf: a run of at most two
//         of the caller's blocks.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/accel/plain_array.h"

#include <cstdint>
#include <functional>

namespace renderer {

struct alignas(32) WideNode {
    static constexpr unsigned kChildren = 8;

    float planes[6][kChildren];     // lower x, upper x, lower y, upper y, lower z, upper z
    std::uint32_t child[kChildren]; // see ChildCode. Children that are not there have empty boxes
};

// A child in 32 bits: an inner node's number, or a leaf's first block and whether it has a second one.
struct ChildCode {
    static constexpr std::uint32_t kLeaf = 1u << 31, kTwoBlocks = 1u << 30, kNumber = kTwoBlocks - 1;

    static std::uint32_t leaf(std::uint32_t first_block, std::uint32_t blocks)
    {
        return kLeaf | (blocks == 2 ? kTwoBlocks : 0) | first_block;
    }
};

struct WideBvh {
    PlainArray<WideNode> nodes; // the root is first; none: nothing to hit
    Bounds3f bounds;
    unsigned depth = 0;
};

// What the leaves hold, the caller fills: `blocks(leaf)` tells how many of its blocks a leaf takes, one or two;
// `reserve(blocks)` is called once, with the number of all; then `fill(leaf, block)` once for every leaf, from many
// threads, with the first of its blocks.
struct LeafFiller {
    std::function<std::uint32_t(std::uint32_t primitives)> blocks;
    std::function<void(std::uint32_t blocks)> reserve;
    std::function<void(const BvhNode<float>& leaf, std::uint32_t block)> fill;
};

// The same tree on any number of threads.
WideBvh widen(const Bvh<float>& bvh, const LeafFiller& leaves, ThreadPool& pool);

} // namespace renderer
