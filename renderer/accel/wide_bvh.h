// WideBvh: a tree of boxes, four children a node, tested at once; made from a binary Bvh<float>.
//
// Layout  128 bytes a node: two cache lines. A child is an inner node, or a leaf: a run of the caller's
//         blocks.
// Cost    traversal is iterative, a fixed stack, no allocation.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/accel/float4.h"
#include "renderer/geometry/box.h"

#include <cstdint>
#include <span>
#include <vector>

namespace renderer {

struct alignas(64) WideNode {
    float planes[6][4];     // lower x, upper x, lower y, upper y, lower z, upper z, of four children
    std::uint32_t child[4]; // leaf: its first block; inner: its node
    std::uint32_t count[4]; // blocks of a leaf; 0: inner. Children that are not there have empty boxes
};

struct WideBvh {
    std::vector<WideNode> nodes; // the root is first; none: nothing to hit
    Bounds3f bounds;
    unsigned depth = 0;
};

// `leaf_blocks(first, count)` is called once for every leaf, in the order of the tree, with its run of
// bvh.order; it returns the leaf's first block and number of blocks, at least one.
struct BlockRun {
    std::uint32_t first, count;
};
template <typename LeafBlocks>
WideBvh widen(const Bvh<float>& bvh, LeafBlocks&& leaf_blocks);

namespace wide {

// Up to four nodes of the binary tree that become the children of one: the largest inner ones are opened
// first.
struct Children {
    BvhNode<float> node[4];
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
            wide.nodes[at].child[i] = run.first;
            wide.nodes[at].count[i] = run.count;
            continue;
        }
        const auto next = static_cast<std::uint32_t>(wide.nodes.size());
        wide.nodes.push_back(empty_node());
        wide.nodes[at].child[i] = next;
        wide.nodes[at].count[i] = 0;
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
    result.nodes.reserve(bvh.pairs.size() / 2 + 1);
    result.nodes.push_back(wide::empty_node());
    wide::widen_into(result, 0, bvh, bvh.root, 1, leaf_blocks);
    result.nodes.shrink_to_fit();
    return result;
}

// Calls leaf(first_block, blocks, end) for leaves that the ray may touch, nearest boxes first; it may draw
// `end` in as hits are found, and returns true to end the walk. A box entered after `end` is passed over; one
// entered exactly there is not, so that ties are seen.
template <typename Leaf>
void traverse(const WideBvh& bvh, const SlabRay<float>& ray, float begin, float end, Leaf&& leaf)
{
    struct Waiting {
        std::uint32_t child, count;
        float entry;
    };
    // Each level leaves at most three behind.
    Waiting stack[3 * kMaxBvhDepth + 1];
    unsigned waiting = 0;
    const std::size_t near_x = ray.negative_x ? 1 : 0, near_y = ray.negative_y ? 3 : 2,
                      near_z = ray.negative_z ? 5 : 4;
    const std::size_t far_x = near_x ^ 1, far_y = near_y ^ 1, far_z = near_z ^ 1;
    const auto splat = [](Vec3f v, std::size_t axis) { return Float4::splat(v[axis]); };
    const Float4 no_x = splat(ray.near_origin, 0), no_y = splat(ray.near_origin, 1),
                 no_z = splat(ray.near_origin, 2);
    const Float4 fo_x = splat(ray.far_origin, 0), fo_y = splat(ray.far_origin, 1),
                 fo_z = splat(ray.far_origin, 2);
    const Float4 ni_x = splat(ray.near_inverse, 0), ni_y = splat(ray.near_inverse, 1),
                 ni_z = splat(ray.near_inverse, 2);
    const Float4 fi_x = splat(ray.far_inverse, 0), fi_y = splat(ray.far_inverse, 1),
                 fi_z = splat(ray.far_inverse, 2);
    const Float4 begins = Float4::splat(begin);

    Waiting next{0, 0, begin};
    if (bvh.nodes.empty()) return;
    for (;;) {
        if (next.count != 0) {
            if (leaf(next.child, next.count, end)) return;
        } else {
            const WideNode& node = bvh.nodes[next.child];
            const auto plane = [&](std::size_t row) { return Float4::load(node.planes[row]); };
            // A NaN (0 * infinity) comes first, so it is dropped: that slab does not restrict.
            const Float4 entry =
                max((plane(near_x) - no_x) * ni_x,
                    max((plane(near_y) - no_y) * ni_y, max((plane(near_z) - no_z) * ni_z, begins)));
            const Float4 exit =
                min((plane(far_x) - fo_x) * fi_x,
                    min((plane(far_y) - fo_y) * fi_y, min((plane(far_z) - fo_z) * fi_z, Float4::splat(end))));
            unsigned hits = less_equal(entry, exit);
            if (hits != 0) {
                alignas(16) float entries[4];
                entry.store(entries);
                const auto take = [&] {
                    const auto i = static_cast<unsigned>(__builtin_ctz(hits));
                    hits &= hits - 1;
                    return Waiting{node.child[i], node.count[i], entries[i]};
                };
                next = take();
                // The nearest is taken at once, the others wait, the nearer above the farther.
                const unsigned base = waiting;
                while (hits != 0) {
                    Waiting other = take();
                    if (other.entry < next.entry) std::swap(other, next);
                    unsigned at = waiting++;
                    for (; at > base && stack[at - 1].entry < other.entry; --at)
                        stack[at] = stack[at - 1];
                    stack[at] = other;
                }
                continue;
            }
        }
        do {
            if (waiting == 0) return;
            next = stack[--waiting];
        } while (next.entry > end);
    }
}

} // namespace renderer
