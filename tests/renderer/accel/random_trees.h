// Binary trees over boxes strewn at random, and what is to hold of any binary tree.
#pragma once

#include "renderer/accel/bvh.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace random_trees {

using namespace renderer;

enum class Boxes { small, with_beams };

// Small boxes; every fifth may be a beam along one of the axes.
inline Bvh<float> tree_over_boxes(std::size_t count,
                                  ThreadPool& pool,
                                  Boxes kind = Boxes::small,
                                  BvhSplit split = BvhSplit::sah)
{
    random_scenes::Random random(3);
    PlainArray<BuildItem<float>> items(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3d low = random.in_box({-1, -1, -1}, {1, 1, 1});
        Vec3d extent = random.in_box({0, 0, 0}, {.05, .05, .05});
        if (kind == Boxes::with_beams && i % 5 == 0) extent[i / 5 % 3] *= 30;
        items[i] = {to_float(low), i, to_float(low + extent)};
    }
    return *build_bvh<float>(std::move(items), {.split = split, .leaf_size = 8, .block = 4}, pool);
}

inline double half_area_of(const BvhNode<float>& node)
{
    return half_area({node.lower, node.upper});
}

// Of all inner nodes.
inline double sum_of_areas(const Bvh<float>& tree)
{
    double sum = tree.root.count == 0 ? half_area_of(tree.root) : 0;
    for (const BvhPair<float>& pair : tree.pairs)
        for (const BvhNode<float>& node : pair.child)
            if (node.count == 0) sum += half_area_of(node);
    return sum;
}

// Every inner node's box is that of its children; `leaf` is called with each leaf. The levels of inner nodes.
template <typename Leaf>
unsigned visit(const Bvh<float>& tree, std::uint32_t number, Leaf&& leaf)
{
    const BvhNode<float>& node = tree.node(number);
    if (node.count != 0) {
        leaf(node);
        return 0;
    }
    const BvhNode<float>(&child)[2] = tree.pairs[node.first].child;
    Bounds3f box{child[0].lower, child[0].upper};
    box.extend({child[1].lower, child[1].upper});
    EXPECT_EQ(box, (Bounds3f{node.lower, node.upper})) << "node " << number;
    return 1 + std::max(visit(tree, 2 * node.first, leaf), visit(tree, 2 * node.first + 1, leaf));
}

} // namespace random_trees
