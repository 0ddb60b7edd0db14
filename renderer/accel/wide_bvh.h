// WideBvh: a tree of boxes, eight children a node, tested at once; made from a binary Bvh<float>.
//
// Layout  224 bytes a node. A child is an inner node, or a leaf: a run of at most two of the caller's blocks.
#pragma once

#include "renderer/accel/bvh.h"

#include <cstdint>
#include <span>
#include <vector>

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
    std::vector<WideNode> nodes; // the root is first; none: nothing to hit
    Bounds3f bounds;
    unsigned depth = 0;
};

// `leaf_blocks(first, count)` is called once for every leaf, in the order of the tree, with its run of
// bvh.order; it returns the leaf's first block and number of blocks, one or two.
struct BlockRun {
    std::uint32_t first, count;
};
template <typename LeafBlocks>
WideBvh widen(const Bvh<float>& bvh, LeafBlocks&& leaf_blocks);

namespace wide {

// Up to eight nodes of the binary tree that become the children of one: the largest inner ones are opened
// first.
struct Children {
    BvhNode<float> node[WideNode::kChildren];
    unsigned count = 0;
};
Children children_of(const Bvh<float>& bvh, const BvhNode<float>& node);
WideNode empty_node();
void set_box(WideNode& node, unsigned slot, const BvhNode<float>& box);

template <typename LeafBlocks>
void widen_into(WideBvh& wide,
                std::uint32_t at,
                const Bvh<float>& bvh,
                const BvhNode<float>& node,
                unsigned depth,
                LeafBlocks& leaf_blocks)
{
    wide.depth = depth > wide.depth ? depth : wide.depth;
    const Children children = children_of(bvh, node);
    for (unsigned i = 0; i < children.count; ++i) {
        const BvhNode<float>& child = children.node[i];
        set_box(wide.nodes[at], i, child);
        if (child.count != 0) {
            const BlockRun run = leaf_blocks(child.first, child.count);
            wide.nodes[at].child[i] = ChildCode::leaf(run.first, run.count);
            continue;
        }
        const auto next = static_cast<std::uint32_t>(wide.nodes.size());
        wide.nodes.push_back(empty_node());
        wide.nodes[at].child[i] = next;
        widen_into(wide, next, bvh, child, depth + 1, leaf_blocks);
    }
}

} // namespace wide

template <typename LeafBlocks>
WideBvh widen(const Bvh<float>& bvh, LeafBlocks&& leaf_blocks)
{
    WideBvh result;
    if (bvh.empty()) return result;
    result.bounds = {bvh.root.lower, bvh.root.upper};
    result.nodes.reserve(bvh.pairs.size() / 4 + 1);
    result.nodes.push_back(wide::empty_node());
    wide::widen_into(result, 0, bvh, bvh.root, 1, leaf_blocks);
    result.nodes.shrink_to_fit();
    return result;
}

} // namespace renderer
