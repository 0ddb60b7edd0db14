#include "renderer/accel/wide_children.h"
#include "tests/renderer/accel/random_trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace {

using namespace renderer;
using namespace random_trees;

double cost_of_best(const Bvh<float>& tree, std::uint32_t number);

// All ways to stand for a node by up to `places` nodes: itself, or those that stand for its children. The areas of
// the inner ones, and what the best choice below them costs.
void add_ways(const Bvh<float>& tree,
              std::uint32_t number,
              std::vector<std::pair<unsigned, double>>& ways,
              bool itself)
{
    const BvhNode<float>& node = tree.node(number);
    if (itself) ways.emplace_back(1, node.count != 0 ? 0 : half_area_of(node) + cost_of_best(tree, number));
    if (node.count != 0) return;
    std::vector<std::pair<unsigned, double>> left, right;
    add_ways(tree, 2 * node.first, left, true);
    add_ways(tree, 2 * node.first + 1, right, true);
    for (const auto& a : left)
        for (const auto& b : right)
            if (a.first + b.first <= WideNode::kChildren)
                ways.emplace_back(a.first + b.first, a.second + b.second);
}

// Of what lies below a wide node, by trying all ways.
double cost_of_best(const Bvh<float>& tree, std::uint32_t number)
{
    std::vector<std::pair<unsigned, double>> ways;
    add_ways(tree, number, ways, false);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& way : ways)
        least = std::min(least, way.second);
    return least;
}

double cost_of_chosen(const Bvh<float>& tree, const WideChildren& children, std::uint32_t number)
{
    double cost = 0;
    const WideChildren::Chosen chosen = children.of(number);
    EXPECT_GE(chosen.count, 2u);
    EXPECT_LE(chosen.count, WideNode::kChildren);
    for (unsigned i = 0; i < chosen.count; ++i)
        if (const BvhNode<float>& node = tree.node(chosen.node[i]); node.count == 0)
            cost += half_area_of(node) + cost_of_chosen(tree, children, chosen.node[i]);
    return cost;
}

} // namespace

TEST(WideChildren, AreThoseOfTheLeastAreaOfAllWays)
{
    ThreadPool pool(1);
    for (const std::size_t boxes : {16u, 40u, 64u, 80u}) {
        const Bvh<float> tree = tree_over_boxes(boxes, pool, Boxes::with_beams);
        ASSERT_EQ(tree.root.count, 0u);
        const double least = cost_of_best(tree, kRootNumber);
        EXPECT_NEAR(cost_of_chosen(tree, WideChildren(tree, pool), kRootNumber), least, 1e-5 * least);
    }
}

TEST(WideChildren, AreTheSameOnAnyNumberOfThreads)
{
    ThreadPool one(1), three(3);
    const Bvh<float> tree = tree_over_boxes(20000, one);
    const WideChildren a(tree, one), b(tree, three);
    for (std::uint32_t number = 0; number < 2 * tree.pairs.size(); ++number) {
        const WideChildren::Chosen x = a.of(number), y = b.of(number);
        ASSERT_EQ(x.count, y.count);
        ASSERT_TRUE(std::equal(x.node.begin(), x.node.begin() + x.count, y.node.begin()));
    }
}

TEST(WideChildren, OfALeafAreItself)
{
    ThreadPool pool(1);
    const Bvh<float> tree = tree_over_boxes(3, pool);
    const WideChildren::Chosen chosen = WideChildren(tree, pool).of(kRootNumber);
    ASSERT_EQ(chosen.count, 1u);
    EXPECT_EQ(chosen.node[0], kRootNumber);
}
