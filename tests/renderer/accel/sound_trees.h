// Binary trees over boxes of either precision, and what is to hold of any of them.
#pragma once

#include "renderer/accel/bvh.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sound_trees {

using namespace renderer;

template <typename T>
std::vector<Bounds3<T>> random_boxes(random_scenes::Random& random, std::size_t count)
{
    std::vector<Bounds3<T>> boxes(count);
    for (Bounds3<T>& box : boxes) {
        const Vec3d low = random.in_box({-1, -1, -1}, {1, 1, 1}),
                    size = random.in_box({0, 0, 0}, {.05, .05, .05});
        for (const Vec3d p : {low, low + size})
            box.extend(Vec3<T>{static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)});
    }
    return boxes;
}

template <typename T>
PlainArray<BuildItem<T>> items_of(const std::vector<Bounds3<T>>& boxes)
{
    PlainArray<BuildItem<T>> items(boxes.size());
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        items[i] = {boxes[i].lower, i, boxes[i].upper};
    return items;
}

template <typename T>
Bvh<T>
build(const std::vector<Bounds3<T>>& boxes, BvhSplit split, unsigned threads = 1, std::uint32_t leaf_size = 4)
{
    ThreadPool pool(threads);
    return *build_bvh<T>(items_of(boxes), {.split = split, .leaf_size = leaf_size}, pool);
}

template <typename T>
bool contains(const BvhNode<T>& node, const Bounds3<T>& box)
{
    Bounds3<T> both{node.lower, node.upper};
    both.extend(box);
    return both == Bounds3<T>{node.lower, node.upper};
}

// Every primitive in one leaf exactly, every box within its parents' boxes, leaves small, depth as told.
template <typename T>
unsigned expect_sound(const Bvh<T>& bvh, const std::vector<Bounds3<T>>& boxes, std::uint32_t leaf_size = 4)
{
    std::vector<std::uint32_t> sorted(bvh.order.begin(), bvh.order.end());
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted.size(), boxes.size());
    for (std::uint32_t i = 0; i < sorted.size(); ++i)
        EXPECT_EQ(sorted[i], i);
    struct Visit {
        BvhNode<T> node;
        unsigned depth;
    };
    std::vector<Visit> open{{bvh.root, 0}};
    std::size_t seen = 0;
    unsigned deepest = 0;
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        deepest = std::max(deepest, visit.depth);
        if (visit.node.count != 0) {
            EXPECT_LE(visit.node.count, leaf_size);
            seen += visit.node.count;
            for (std::uint32_t i = 0; i < visit.node.count; ++i)
                EXPECT_TRUE(contains(visit.node, boxes[bvh.order[visit.node.first + i]]));
            continue;
        }
        for (const BvhNode<T>& child : bvh.pairs[visit.node.first].child) {
            EXPECT_TRUE(contains(visit.node, Bounds3<T>{child.lower, child.upper}));
            open.push_back({child, visit.depth + 1});
        }
    }
    EXPECT_EQ(seen, boxes.size());
    EXPECT_EQ(deepest, bvh.depth);
    EXPECT_LE(deepest, kMaxBvhDepth);
    return deepest;
}

} // namespace sound_trees
