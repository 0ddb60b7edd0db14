#include "renderer/accel/bvh_topology_cache.h"
#include "tests/renderer/accel/sound_trees.h"

#include <gtest/gtest.h>

#include <cstdint>
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

struct How {
    BvhSplit split = BvhSplit::sah;
    std::uint64_t kinds = 0;
};

void keep(BvhTopologyCache& cache, const std::vector<Bounds3d>& boxes, const How& how = {})
{
    cache.keep(build(boxes, how.split), {how.split, boxes.size(), how.kinds});
}

bool refits(BvhTopologyCache& cache, const std::vector<Bounds3d>& boxes, const How& how = {})
{
    const PlainArray<BuildItem<double>> items = items_of(boxes);
    ThreadPool pool(1);
    return cache.refit({items.data(), items.size()}, {how.split, boxes.size(), how.kinds}, 0.1, pool)
        .has_value();
}

} // namespace

TEST(BvhTopologyCache, RefitsATreeThatWasBuiltAlike)
{
    BvhTopologyCache cache;
    const auto boxes = boxes_of(1, 500);
    EXPECT_FALSE(refits(cache, boxes));
    keep(cache, boxes);
    EXPECT_TRUE(refits(cache, boxes));
    EXPECT_FALSE(refits(cache, boxes, {.split = BvhSplit::midpoint}));
    EXPECT_FALSE(refits(cache, boxes, {.kinds = 1}));
    EXPECT_FALSE(refits(cache, boxes_of(1, 501)));
    EXPECT_FALSE(refits(cache, boxes_of(2, 500))); // as many, elsewhere
}

TEST(BvhTopologyCache, HasRoomForTwoAnimationsOfAsManyObjects)
{
    BvhTopologyCache cache;
    const auto one = boxes_of(1, 500), other = boxes_of(2, 500);
    keep(cache, one, {.kinds = 1});
    keep(cache, other, {.kinds = 2});
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_TRUE(refits(cache, one, {.kinds = 1}));
        EXPECT_TRUE(refits(cache, other, {.kinds = 2}));
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

TEST(BvhTopologyCache, LosesNothingToATreeThatIsOneByteLargerThanItself)
{
    BvhTopologyCache sizes;
    const auto small = boxes_of(1, 100), large = boxes_of(2, 1000);
    keep(sizes, large);
    BvhTopologyCache cache(sizes.size_bytes() - 1);
    keep(cache, small);
    keep(cache, large);
    EXPECT_TRUE(refits(cache, small));
    EXPECT_FALSE(refits(cache, large));
}

TEST(BvhTopologyCache, KeepsTheNewestOfTreesThatWereBuiltAlike)
{
    BvhTopologyCache cache;
    const auto one = boxes_of(1, 500), other = boxes_of(2, 500);
    keep(cache, one);
    const std::uint64_t bytes = cache.size_bytes();
    keep(cache, other);
    EXPECT_TRUE(refits(cache, other));
    EXPECT_FALSE(refits(cache, one));
    EXPECT_LT(cache.size_bytes(), bytes * 3 / 2);
}

TEST(BvhTopologyCache, KeepsSoManySmallTreesAndNoMore)
{
    BvhTopologyCache cache;
    constexpr std::size_t kMost = 64;
    for (std::size_t i = 0; i <= kMost; ++i)
        keep(cache, boxes_of(i, 10 + i));
    EXPECT_FALSE(refits(cache, boxes_of(0, 10)));
    for (std::size_t i = 1; i <= kMost; ++i)
        EXPECT_TRUE(refits(cache, boxes_of(i, 10 + i))) << i;
}

TEST(BvhTopologyCache, KeepsNoTreeThatCouldNeverBeRefitted)
{
    BvhTopologyCache cache;
    keep(cache, std::vector<Bounds3d>(100, Bounds3d{{1, 2, 3}, {1, 2, 3}}));
    keep(cache, boxes_of(1, 1));
    EXPECT_EQ(cache.size_bytes(), 0u);
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
