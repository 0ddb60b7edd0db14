#include "renderer/accel/reinsertion.h"
#include "tests/renderer/accel/random_trees.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <stop_token>
#include <vector>

namespace {

using namespace renderer;
using namespace random_trees;

// Leaves by where their run starts.
std::map<std::uint32_t, BvhNode<float>> leaves_of(const Bvh<float>& tree, unsigned& depth)
{
    std::map<std::uint32_t, BvhNode<float>> leaves;
    depth = visit(tree, kRootNumber, [&](const BvhNode<float>& leaf) {
        EXPECT_TRUE(leaves.emplace(leaf.first, leaf).second) << "a leaf is met twice";
    });
    return leaves;
}

bool same_bits(const Bvh<float>& a, const Bvh<float>& b)
{
    return a.pairs.size_bytes() == b.pairs.size_bytes() &&
           std::memcmp(a.pairs.data(), b.pairs.data(), a.pairs.size_bytes()) == 0;
}

// A leaf and all the rest at every level: as deep as a tree may be, and bad.
Bvh<float> comb()
{
    random_scenes::Random random(11);
    Bvh<float> tree;
    tree.depth = kMaxBvhDepth;
    tree.pairs = PlainArray<BvhPair<float>>(kMaxBvhDepth);
    tree.order = PlainArray<std::uint32_t>(kMaxBvhDepth + 1);
    const auto leaf = [&](std::uint32_t number) {
        tree.order[number] = number;
        const Vec3d low = random.in_box({-1, -1, -1}, {1, 1, 1});
        return BvhNode<float>{to_float(low), number, to_float(low + Vec3d{.1, .1, .1}), 1};
    };
    BvhNode<float> below = leaf(kMaxBvhDepth);
    for (std::uint32_t pair = kMaxBvhDepth; pair-- > 0;) {
        tree.pairs[pair] = {{leaf(pair), below}};
        Bounds3f box{below.lower, below.upper};
        box.extend({tree.pairs[pair].child[0].lower, tree.pairs[pair].child[0].upper});
        below = {box.lower, pair, box.upper, 0};
    }
    tree.root = below;
    return tree;
}

} // namespace

TEST(Reinsertion, KeepsEveryLeafAndMakesTheBoxesSmaller)
{
    ThreadPool pool(2);
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint}) {
        Bvh<float> tree = tree_over_boxes(20000, pool, Boxes::with_beams, split);
        unsigned depth = 0;
        const auto before = leaves_of(tree, depth);
        const double area = sum_of_areas(tree);
        reinsert_largest(tree, pool);
        const auto after = leaves_of(tree, depth);
        EXPECT_EQ(tree.depth, depth);
        EXPECT_LE(depth, kMaxBvhDepth);
        EXPECT_LT(sum_of_areas(tree) / area, 0.98) << "split " << static_cast<int>(split);
        ASSERT_EQ(after.size(), before.size());
        for (const auto& [first, leaf] : before)
            EXPECT_EQ(std::memcmp(&leaf, &after.at(first), sizeof leaf), 0);
    }
}

TEST(Reinsertion, GivesTheSameTreeOnAnyNumberOfThreads)
{
    ThreadPool one(1), three(3);
    Bvh<float> tree = tree_over_boxes(20000, one, Boxes::with_beams),
               other = tree_over_boxes(20000, three, Boxes::with_beams);
    const Bvh<float> untouched = tree_over_boxes(20000, one, Boxes::with_beams);
    reinsert_largest(tree, one);
    reinsert_largest(other, three);
    EXPECT_TRUE(same_bits(tree, other));
    EXPECT_FALSE(same_bits(tree, untouched));
}

TEST(Reinsertion, LeavesNoTreeDeeperThanAWalkCanFollow)
{
    ThreadPool pool(1);
    Bvh<float> tree = comb();
    const double area = sum_of_areas(tree);
    reinsert_largest(tree, pool);
    unsigned depth = 0;
    EXPECT_EQ(leaves_of(tree, depth).size(), kMaxBvhDepth + 1);
    EXPECT_EQ(tree.depth, depth);
    EXPECT_LE(depth, kMaxBvhDepth);
    EXPECT_LT(sum_of_areas(tree), area);
}

TEST(Reinsertion, LeavesTreesOfFewNodesAndThoseOfAStoppedBuildAlone)
{
    ThreadPool pool(1);
    for (const std::size_t boxes : {0u, 1u, 5u, 9u, 20u}) {
        Bvh<float> tree = tree_over_boxes(boxes, pool);
        unsigned depth = 0;
        if (boxes > 0) leaves_of(tree, depth);
        reinsert_largest(tree, pool);
        if (boxes > 0) leaves_of(tree, depth);
        EXPECT_EQ(tree.depth, depth);
    }
    std::stop_source stopped;
    stopped.request_stop();
    Bvh<float> tree = tree_over_boxes(2000, pool);
    const Bvh<float> before = tree_over_boxes(2000, pool);
    reinsert_largest(tree, pool, stopped.get_token());
    EXPECT_TRUE(same_bits(tree, before));
}
