#include "renderer/accel/wide_bvh.h"
#include "tests/renderer/accel/random_trees.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <vector>

namespace {

using namespace renderer;
using random_trees::tree_over_boxes;

// A tree whose leaves note which run of the order they hold.
struct Widened {
    WideBvh tree;
    std::vector<BvhNode<float>> leaves; // by first block
    std::vector<std::atomic<int>> filled;
};

std::unique_ptr<Widened> widened(const Bvh<float>& bvh, unsigned threads)
{
    auto result = std::make_unique<Widened>();
    ThreadPool pool(threads);
    const LeafFiller leaves{.blocks = [](std::uint32_t count) { return (count + 3) / 4; },
                            .reserve =
                                [&](std::uint32_t blocks) {
                                    result->leaves.resize(blocks);
                                    result->filled = std::vector<std::atomic<int>>(blocks);
                                },
                            .fill =
                                [&](const BvhNode<float>& leaf, std::uint32_t block) {
                                    result->leaves[block] = leaf;
                                    for (std::uint32_t i = 0; i < (leaf.count + 3) / 4; ++i)
                                        ++result->filled[block + i];
                                }};
    result->tree = widen(bvh, leaves, pool);
    return result;
}

// Every node is met once, every box lies in its parent's, every leaf says what the binary tree said.
void expect_sound(const Widened& wide, const Bvh<float>& bvh)
{
    struct Visit {
        std::uint32_t node;
        Bounds3f box;
        unsigned depth;
    };
    std::vector<Visit> open{{0, wide.tree.bounds, 1}};
    std::vector<int> met(wide.tree.nodes.size()), primitives(bvh.order.size());
    unsigned deepest = 0;
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        ++met[visit.node];
        deepest = std::max(deepest, visit.depth);
        const WideNode& node = wide.tree.nodes[visit.node];
        for (unsigned i = 0; i < WideNode::kChildren; ++i) {
            const Bounds3f box{{node.planes[0][i], node.planes[2][i], node.planes[4][i]},
                               {node.planes[1][i], node.planes[3][i], node.planes[5][i]}};
            if (box.empty()) continue;
            Bounds3f both = visit.box;
            both.extend(box);
            ASSERT_EQ(both, visit.box);
            if ((node.child[i] & ChildCode::kLeaf) == 0) {
                open.push_back({node.child[i], box, visit.depth + 1});
                continue;
            }
            const BvhNode<float>& leaf = wide.leaves[node.child[i] & ChildCode::kNumber];
            EXPECT_EQ((node.child[i] & ChildCode::kTwoBlocks) != 0, leaf.count > 4);
            EXPECT_EQ(box, (Bounds3f{leaf.lower, leaf.upper}));
            for (std::uint32_t k = 0; k < leaf.count; ++k)
                ++primitives[bvh.order[leaf.first + k]];
        }
    }
    EXPECT_EQ(std::count(met.begin(), met.end(), 1), std::ssize(met));
    EXPECT_EQ(std::count(primitives.begin(), primitives.end(), 1), std::ssize(primitives));
    EXPECT_EQ(std::count(wide.filled.begin(), wide.filled.end(), 1), std::ssize(wide.filled));
    EXPECT_EQ(deepest, wide.tree.depth);
}

TEST(WideBvh, HoldsEveryLeafOnce)
{
    ThreadPool pool(1);
    for (const std::size_t count : {1u, 4u, 5u, 9u, 200u, 70000u}) {
        const Bvh<float> bvh = tree_over_boxes(count, pool);
        expect_sound(*widened(bvh, 1), bvh);
    }
}

TEST(WideBvh, IsTheSameOnAnyNumberOfThreads)
{
    ThreadPool pool(2);
    const Bvh<float> bvh = tree_over_boxes(70000, pool);
    const auto one = widened(bvh, 1);
    ASSERT_GT(one->tree.nodes.size(), 1000u) << "large enough to have been shared";
    for (const unsigned threads : {2u, 5u}) {
        const auto many = widened(bvh, threads);
        ASSERT_EQ(many->tree.nodes.size(), one->tree.nodes.size());
        EXPECT_EQ(std::memcmp(many->tree.nodes.data(), one->tree.nodes.data(), one->tree.nodes.size_bytes()),
                  0);
        ASSERT_EQ(many->leaves.size(), one->leaves.size());
        for (std::size_t i = 0; i < one->leaves.size(); ++i)
            EXPECT_EQ(many->leaves[i].first, one->leaves[i].first);
    }
}

TEST(WideBvh, OfNothingHasNoNodes)
{
    ThreadPool pool(1);
    EXPECT_TRUE(widened(tree_over_boxes(0, pool), 1)->tree.nodes.empty());
}

} // namespace
