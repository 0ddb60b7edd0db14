#include "renderer/accel/bvh_topology.h"
#include "tests/renderer/accel/sound_trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// As of the objects of a scene: one a leaf.
Bvh<double> tree_over(const Boxes& boxes, BvhSplit split = BvhSplit::sah)
{
    return build(boxes, split, 1, 1);
}

BvhTopology topology_over(const Boxes& boxes)
{
    return {tree_over(boxes), boxes.size()};
}

std::optional<Bvh<double>>
refit(const BvhTopology& topology, const Boxes& boxes, double visits_more, unsigned threads = 1)
{
    ThreadPool pool(threads);
    const PlainArray<BuildItem<double>> items = items_of(boxes);
    return topology.refit({items.data(), items.size()}, visits_more, pool);
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

void expect_same(const Bvh<double>& a, const Bvh<double>& b)
{
    EXPECT_EQ(a.depth, b.depth);
    ASSERT_EQ(a.pairs.size(), b.pairs.size());
    EXPECT_TRUE(same(a.root, b.root));
    for (std::uint32_t number = 0; number < 2 * a.pairs.size(); ++number)
        ASSERT_TRUE(same(a.node(number), b.node(number))) << number;
    EXPECT_TRUE(std::equal(a.order.begin(), a.order.end(), b.order.begin(), b.order.end()));
}

// Inner nodes below the root that a ray visits on average, the root counted.
double visits(const Bvh<double>& tree)
{
    std::vector<double> inner(tree.pairs.size());
    for (std::size_t i = inner.size(); i-- > 0;) {
        const BvhNode<double>(&child)[2] = tree.pairs[i].child;
        Bounds3d box{child[0].lower, child[0].upper};
        box.extend({child[1].lower, child[1].upper});
        double sum = 0;
        for (const BvhNode<double>& node : child)
            if (node.count == 0) sum += half_area(Bounds3d{node.lower, node.upper}) * inner[node.first];
        inner[i] = 1 + sum / half_area(box);
    }
    return inner.front();
}

} // namespace

TEST(BvhTopology, GivesTheSameTreeAgainAroundTheSameBoxes)
{
    Random random(1);
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint})
        for (const std::size_t count : {2u, 3u, 1000u, 20000u}) {
            const Boxes boxes = random_boxes<double>(random, count);
            const Bvh<double> built = tree_over(boxes, split);
            const auto again = refit({built, count}, boxes, 0);
            ASSERT_TRUE(again) << count;
            expect_same(*again, built);
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

TEST(BvhTopology, IsRefittedTheSameOnAnyNumberOfThreads)
{
    Random random(9);
    const Boxes boxes = random_boxes<double>(random, 30000), there = moved(boxes, random, 0.01),
                elsewhere = shuffled(boxes, random, 0, boxes.size());
    const BvhTopology topology = topology_over(boxes);
    const auto one = refit(topology, there, kAnyNumber);
    for (const unsigned threads : {2u, 5u}) {
        const auto many = refit(topology, there, kAnyNumber, threads);
        ASSERT_TRUE(one && many);
        expect_same(*one, *many);
        EXPECT_FALSE(refit(topology, elsewhere, 100, threads));
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
    const BvhTopology topology(*build_bvh<double>(std::move(items), {.leaf_size = 1}, pool), 100);
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

TEST(BvhTopology, IsKeptUpToAsManyVisitsMoreAsAreAllowed)
{
    Random random(10);
    const Boxes boxes = cubes(6), there = moved(boxes, random, 0.4);
    const BvhTopology topology = topology_over(boxes);
    const double more = visits(*refit(topology, there, kAnyNumber)) - visits(tree_over(boxes));
    ASSERT_GT(more, 1);
    // What is left of the boxes' share of the whole makes the guess smaller still, and deeper nodes may lose more.
    EXPECT_FALSE(refit(topology, there, 0.999 * more));
    EXPECT_TRUE(refit(topology, there, 3 * more));
}

TEST(BvhTopology, DoesNotHopeForMoreVisitsWhereBoxesHaveGrown)
{
    // As good or bad as it was, a tree over larger boxes is never taken for better than it was.
    const Boxes boxes = cubes(8, 0.1);
    Random random(11);
    Boxes larger = shuffled(boxes, random, 0, boxes.size());
    for (Bounds3d& box : larger)
        box.upper = box.lower + Vec3d{0.9, 0.9, 0.9};
    EXPECT_FALSE(refit(topology_over(boxes), larger, 20));
}

TEST(BvhTopology, OfBoxesThatNoTreeTellsApartIsNotForcedUponOthers)
{
    // Needles that cross in one place: every node is the whole, with next to no leaves in it. By what it was, all is better.
    Random random(12);
    for (const double thickness : {1e-9, 1e-4, 1e-3, 0.03})
        for (const std::size_t count : {100u, 1000u, 20000u}) {
            Boxes needles;
            for (std::size_t i = 0; i < count; ++i) {
                const Vec3d half =
                    i % 2 == 0 ? Vec3d{1, thickness, thickness} : Vec3d{thickness, 1, thickness};
                needles.push_back({-half, half});
            }
            const BvhTopology topology = topology_over(needles);
            Boxes volume, floor;
            const double side = std::cbrt(static_cast<double>(count));
            for (std::size_t i = 0; i < count; ++i) {
                const Vec3d low = random.in_box({0, 0, 0}, {side, side, side}), in_plane{low.x, 0, low.z};
                volume.push_back({low, low + Vec3d{0.4, 0.4, 0.4}});
                floor.push_back({in_plane, in_plane + Vec3d{0.2, 0.2, 0.2}});
            }
            EXPECT_FALSE(refit(topology, volume, 1)) << count << " " << thickness;
            EXPECT_FALSE(refit(topology, floor, 1)) << count << " " << thickness;
        }
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

TEST(BvhTopology, OfATreeOverNothingIsNoTree)
{
    const BvhTopology topology(Bvh<double>{}, 0);
    EXPECT_FALSE(refit(topology, {}, kAnyNumber));
    EXPECT_FALSE(topology.is_of_use());
    EXPECT_FALSE(topology_over({{{0, 0, 0}, {1, 1, 1}}}).is_of_use()); // nor over one primitive
    EXPECT_FALSE(topology_over(Boxes(10, Bounds3d{{1, 2, 3}, {1, 2, 3}})).is_of_use());
    EXPECT_TRUE(topology_over(cubes(2)).is_of_use());
}
