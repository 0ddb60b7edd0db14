#include "renderer/accel/bvh_topology.h"
#include "tests/renderer/accel/sound_trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace {

using namespace renderer;
using namespace sound_trees;
using random_scenes::Random;

constexpr double kAnyNumber = std::numeric_limits<double>::infinity();

using Boxes = std::vector<Bounds3d>;

BvhTopology topology_over(const Boxes& boxes, BvhSplit split = BvhSplit::sah)
{
    return {build(boxes, split), boxes.size()};
}

std::optional<Bvh<double>> refit(const BvhTopology& topology, const Boxes& boxes, double visits_more)
{
    const PlainArray<BuildItem<double>> items = items_of(boxes);
    return topology.refit({items.data(), items.size()}, visits_more);
}

// Cubes side by side in the cells of a cube.
Boxes cubes(int side, double size = 0.5)
{
    Boxes boxes;
    for (int i = 0; i < side * side * side; ++i) {
        const Vec3d low{1.0 * (i % side), 1.0 * (i / side % side), 1.0 * (i / side / side)};
        boxes.push_back({low, low + Vec3d{size, size, size}});
    }
    return boxes;
}

Boxes shuffled(Boxes boxes, Random& random, std::size_t first, std::size_t last)
{
    for (std::size_t i = last - 1; i > first; --i)
        std::swap(boxes[i], boxes[first + random.below(static_cast<std::uint32_t>(i - first + 1))]);
    return boxes;
}

Boxes moved(Boxes boxes, Random& random, double by)
{
    for (Bounds3d& box : boxes) {
        const Vec3d d = random.direction() * by;
        box = {box.lower + d, box.upper + d};
    }
    return boxes;
}

bool same(const BvhNode<double>& a, const BvhNode<double>& b)
{
    return a.lower == b.lower && a.upper == b.upper && a.first == b.first && a.count == b.count;
}

} // namespace

TEST(BvhTopology, GivesTheSameTreeAgainAroundTheSameBoxes)
{
    Random random(1);
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint})
        for (const std::size_t count : {1u, 2u, 3u, 1000u, 20000u}) {
            const Boxes boxes = random_boxes<double>(random, count);
            const Bvh<double> built = build(boxes, split);
            const auto again = refit({built, count}, boxes, 0);
            ASSERT_TRUE(again) << count;
            EXPECT_EQ(again->depth, built.depth);
            ASSERT_EQ(again->pairs.size(), built.pairs.size());
            EXPECT_TRUE(same(again->root, built.root));
            for (std::uint32_t number = 0; number < 2 * built.pairs.size(); ++number)
                ASSERT_TRUE(same(again->node(number), built.node(number))) << number;
            EXPECT_TRUE(std::equal(built.order.begin(), built.order.end(), again->order.begin()));
        }
}

TEST(BvhTopology, PutsMovedBoxesIntoEveryNodeAboveThem)
{
    Random random(2);
    const Boxes boxes = random_boxes<double>(random, 3000);
    const BvhTopology topology = topology_over(boxes);
    for (const double by : {1e-9, 0.01, 1.0, 1000.0}) {
        const Boxes there = moved(boxes, random, by);
        const auto tree = refit(topology, there, kAnyNumber);
        ASSERT_TRUE(tree);
        expect_sound(*tree, there);
        Bounds3d whole;
        for (const Bounds3d& box : there)
            whole.extend(box);
        EXPECT_EQ(whole, (Bounds3d{tree->root.lower, tree->root.upper})); // and no larger
    }
}

TEST(BvhTopology, LeavesOutThePrimitivesWithoutABox)
{
    Random random(3);
    Boxes boxes = random_boxes<double>(random, 100);
    PlainArray<BuildItem<double>> items = items_of(boxes);
    std::swap(items[40], items[99]);
    items.shorten(99);
    ThreadPool pool(1);
    const BvhTopology topology(*build_bvh<double>(std::move(items), {}, pool), 100);
    EXPECT_FALSE(refit(topology, boxes, kAnyNumber)); // 40 has one now
    boxes[40] = {};
    const auto tree = refit(topology, boxes, 0);
    ASSERT_TRUE(tree);
    EXPECT_EQ(std::count(tree->order.begin(), tree->order.end(), 40u), 0);
    boxes[41] = {};
    EXPECT_FALSE(refit(topology, boxes, kAnyNumber));
    boxes[40] = {{0, 0, 0}, {1, 1, 1}}; // as many as there were
    EXPECT_FALSE(refit(topology, boxes, kAnyNumber));
    boxes.pop_back();
    EXPECT_FALSE(refit(topology, boxes, kAnyNumber));
}

TEST(BvhTopology, StaysWhereBoxesMoveLittleOrTogether)
{
    Random random(4);
    const Boxes boxes = cubes(12);
    const BvhTopology topology = topology_over(boxes);
    EXPECT_TRUE(refit(topology, moved(boxes, random, 0.001), 0.1));
    Boxes together = boxes;
    for (Bounds3d& box : together)
        box = {box.lower * 4.0 + Vec3d{1e6, 0, 0}, box.upper * 4.0 + Vec3d{1e6, 0, 0}};
    EXPECT_TRUE(refit(topology, together, 1e-6));
    Boxes one = boxes;
    one[700] = {{30, 30, 30}, {30.5, 30.5, 30.5}}; // the nodes above it become larger, no others
    EXPECT_FALSE(refit(topology, one, 1));
    EXPECT_TRUE(refit(topology, one, 20));
}

TEST(BvhTopology, IsGivenUpWhereBoxesHaveChangedPlaces)
{
    Random random(5);
    const Boxes boxes = cubes(12);
    const BvhTopology topology = topology_over(boxes);
    EXPECT_FALSE(refit(topology, shuffled(boxes, random, 0, boxes.size()), 100));
    EXPECT_TRUE(refit(topology, shuffled(boxes, random, 0, boxes.size()), kAnyNumber));
}

TEST(BvhTopology, IsGivenUpForATangleInASmallCornerOfALargeScene)
{
    // Rays that cross the whole hardly meet the corner, but the camera may be there.
    Random random(6);
    Boxes boxes = cubes(8);
    const std::size_t first = boxes.size();
    for (const Bounds3d& box : cubes(8))
        boxes.push_back({box.lower * 0.001, box.upper * 0.001});
    const BvhTopology topology = topology_over(boxes);
    EXPECT_TRUE(refit(topology, boxes, 0));
    EXPECT_FALSE(refit(topology, shuffled(boxes, random, first, boxes.size()), 20));
}

TEST(BvhTopology, IsGivenUpWhereWhatWasInOnePlaceIsScattered)
{
    // All was in all nodes, so no node has become worse, but a tree built anew would be far better.
    Random random(7);
    const Boxes apart = shuffled(cubes(10), random, 0, 1000);
    Boxes together = apart;
    for (Bounds3d& box : together)
        box = moved({{{0, 0, 0}, box.extent()}}, random, 0.01).front();
    const BvhTopology topology = topology_over(together);
    EXPECT_TRUE(refit(topology, together, 0));
    EXPECT_FALSE(refit(topology, apart, 100));
}

TEST(BvhTopology, IsGivenUpWhereAreasAreNoNumbers)
{
    Random random(8);
    const Boxes boxes = random_boxes<double>(random, 10);
    const BvhTopology topology = topology_over(boxes);
    Boxes huge = boxes;
    for (Bounds3d& box : huge)
        box = {box.lower * 1e200, box.upper * 1e200};
    EXPECT_FALSE(refit(topology, huge, kAnyNumber));
    const Boxes points(10, Bounds3d{{1, 2, 3}, {1, 2, 3}});
    EXPECT_FALSE(refit(topology, points, kAnyNumber));
    EXPECT_FALSE(refit(topology_over(points), points, kAnyNumber));
}
