#include "renderer/accel/bvh_topology_cache.h"
#include "tests/renderer/accel/sound_trees.h"

#include <gtest/gtest.h>

#include <span>
#include <thread>
#include <vector>

namespace {

using namespace renderer;
using namespace sound_trees;
using random_scenes::Random;

std::vector<Bounds3d> boxes_of(std::uint64_t seed, std::size_t count)
{
    Random random(seed);
    return random_boxes<double>(random, count);
}

void keep(BvhTopologyCache& cache, const std::vector<Bounds3d>& boxes, BvhSplit split = BvhSplit::sah)
{
    cache.keep(build(boxes, split), boxes.size(), split);
}

bool refits(BvhTopologyCache& cache, const std::vector<Bounds3d>& boxes, BvhSplit split = BvhSplit::sah)
{
    const PlainArray<BuildItem<double>> items = items_of(boxes);
    return cache.refit({items.data(), items.size()}, split, 0.1).has_value();
}

} // namespace

TEST(BvhTopologyCache, RefitsATreeThatWasBuiltTheSameWayOverAsMany)
{
    BvhTopologyCache cache;
    const auto boxes = boxes_of(1, 500);
    EXPECT_FALSE(refits(cache, boxes));
    keep(cache, boxes);
    EXPECT_TRUE(refits(cache, boxes));
    EXPECT_FALSE(refits(cache, boxes, BvhSplit::midpoint));
    EXPECT_FALSE(refits(cache, boxes_of(1, 501)));
    EXPECT_FALSE(refits(cache, boxes_of(2, 500))); // as many, elsewhere
}

TEST(BvhTopologyCache, HasRoomForTwoAnimationsOfAsManyObjects)
{
    BvhTopologyCache cache;
    const auto one = boxes_of(1, 500), other = boxes_of(2, 500);
    keep(cache, one);
    keep(cache, other);
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_TRUE(refits(cache, one));
        EXPECT_TRUE(refits(cache, other));
    }
}

TEST(BvhTopologyCache, ForgetsTheTreeThatWasUsedLongestAgo)
{
    const auto one = boxes_of(1, 500), other = boxes_of(2, 510), third = boxes_of(3, 505);
    BvhTopologyCache sizes;
    keep(sizes, one);
    BvhTopologyCache cache(5 * sizes.size_bytes() / 2); // two and a half
    keep(cache, one);
    keep(cache, other);
    EXPECT_TRUE(refits(cache, one));
    keep(cache, third);
    EXPECT_TRUE(refits(cache, one));
    EXPECT_FALSE(refits(cache, other));
    EXPECT_TRUE(refits(cache, third));
    EXPECT_LE(cache.size_bytes(), 5 * sizes.size_bytes() / 2);
}

TEST(BvhTopologyCache, DoesNotKeepATreeThatIsLargerThanItself)
{
    BvhTopologyCache sizes;
    const auto small = boxes_of(1, 100), large = boxes_of(2, 1000);
    keep(sizes, small);
    BvhTopologyCache cache(2 * sizes.size_bytes());
    keep(cache, small);
    keep(cache, large);
    EXPECT_TRUE(refits(cache, small));
    EXPECT_FALSE(refits(cache, large));
}

TEST(BvhTopologyCache, ServesSeveralThreadsAtOnce)
{
    BvhTopologyCache cache(200'000);
    std::vector<std::jthread> threads;
    for (std::uint64_t t = 0; t < 4; ++t)
        threads.emplace_back([&cache, t] {
            for (std::uint64_t i = 0; i < 20; ++i) {
                const auto boxes = boxes_of(t, 200 + 10 * i);
                keep(cache, boxes);
                refits(cache, boxes);
            }
        });
    threads.clear();
    EXPECT_LE(cache.size_bytes(), 200'000u);
    EXPECT_GT(cache.size_bytes(), 0u);
}
