#include "renderer/accel/bvh.h"
#include "renderer/accel/traverse.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/renderer/accel/sound_trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace {

using namespace renderer;
using random_scenes::Random;
using namespace sound_trees;

class BvhOfEitherSplit : public ::testing::TestWithParam<BvhSplit> {};
INSTANTIATE_TEST_SUITE_P(Split,
                         BvhOfEitherSplit,
                         ::testing::Values(BvhSplit::sah, BvhSplit::midpoint),
                         [](const auto& split) { return split.param == BvhSplit::sah ? "sah" : "midpoint"; });

TEST_P(BvhOfEitherSplit, HoldsEveryPrimitiveOnce)
{
    Random random(1);
    for (const std::size_t count : {1u, 2u, 3u, 5u, 100u, 20000u}) {
        const auto narrow = random_boxes<float>(random, count);
        expect_sound(build(narrow, GetParam()), narrow);
        const auto wide = random_boxes<double>(random, count);
        expect_sound(build(wide, GetParam()), wide);
    }
    const std::vector<Bounds3f> none;
    EXPECT_TRUE(build(none, GetParam()).empty());
}

TEST_P(BvhOfEitherSplit, IsTheSameOnAnyNumberOfThreads)
{
    Random random(2);
    const auto boxes = random_boxes<float>(random, 60000);
    const Bvh<float> one = build(boxes, GetParam(), 1);
    for (const unsigned threads : {2u, 3u, 8u}) {
        const Bvh<float> many = build(boxes, GetParam(), threads);
        ASSERT_TRUE(std::equal(many.order.begin(), many.order.end(), one.order.begin(), one.order.end()));
        ASSERT_EQ(many.pairs.size(), one.pairs.size());
        EXPECT_EQ(std::memcmp(many.pairs.data(), one.pairs.data(), one.pairs.size_bytes()), 0);
    }
    EXPECT_GT(one.pairs.size(), 60000u / 4); // large enough to have been shared among threads
}

TEST_P(BvhOfEitherSplit, EndsWhereNothingTellsPrimitivesApart)
{
    // Copies, and boxes of many sizes around one centre.
    const std::vector<Bounds3f> copies(100000, Bounds3f{{1, 2, 3}, {4, 5, 6}});
    expect_sound(build(copies, GetParam()), copies);
    std::vector<Bounds3f> nested;
    for (int i = 1; i <= 1000; ++i) {
        const auto r = static_cast<float>(i);
        nested.push_back({{-r, -r, -r}, {r, r, r}});
    }
    expect_sound(build(nested, GetParam()), nested);
    const std::vector<Bounds3f> points(1000, Bounds3f{{0, 0, 0}, {0, 0, 0}});
    expect_sound(build(points, GetParam()), points);
}

TEST_P(BvhOfEitherSplit, HoldsAPrimitiveAsOftenAsItWasGiven)
{
    // Parts of one primitive may be given apart from one another.
    Random random(7);
    const auto boxes = random_boxes<float>(random, 10000);
    auto items = items_of(boxes);
    for (BuildItem<float>& item : items)
        item.primitive /= 2;
    ThreadPool pool(2);
    const auto bvh = build_bvh<float>(std::move(items), {.split = GetParam()}, pool);
    std::vector<int> seen(5000);
    for (const std::uint32_t primitive : bvh->order)
        ++seen[primitive];
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 2), 5000);
}

TEST_P(BvhOfEitherSplit, GivesUpInTheMidstOfIt)
{
    Random random(11);
    const auto boxes = random_boxes<float>(random, 60000);
    for (int i = 0; i < 20; ++i) {
        ThreadPool pool(3);
        std::stop_source stop;
        std::jthread stopper([&] {
            std::this_thread::sleep_for(std::chrono::microseconds(200 * i));
            stop.request_stop();
        });
        const auto bvh = build_bvh<float>(items_of(boxes), {.split = GetParam()}, pool, stop.get_token());
        if (bvh) expect_sound(*bvh, boxes);
    }
}

TEST_P(BvhOfEitherSplit, StaysShallowOnALineOfGrowingSteps)
{
    std::vector<Bounds3f> narrow;
    double x = 1;
    for (int i = 0; i < 100000; ++i, x *= 1.0005) {
        const auto low = static_cast<float>(x), high = static_cast<float>(x * 1.0002);
        narrow.push_back({{low, 0, 0}, {high, 0, 0}});
    }
    ASSERT_TRUE(std::isfinite(narrow.back().upper.x));
    expect_sound(build(narrow, GetParam()), narrow);
    std::vector<Bounds3d> wide; // up to 2^1000, areas far beyond double's range
    x = 1;
    for (int i = 0; i < 1000; ++i, x *= 2)
        wide.push_back({{x, x, -x}, {x * 1.5, x * 1.5, x}});
    expect_sound(build(wide, GetParam()), wide);
}

TEST_P(BvhOfEitherSplit, GivesUpWhenAskedToStop)
{
    Random random(5);
    const auto boxes = random_boxes<float>(random, 1000);
    ThreadPool pool(2);
    std::stop_source stop;
    EXPECT_TRUE(build_bvh<float>(items_of(boxes), {.split = GetParam()}, pool, stop.get_token()));
    stop.request_stop();
    EXPECT_FALSE(build_bvh<float>(items_of(boxes), {.split = GetParam()}, pool, stop.get_token()));
}

TEST_P(BvhOfEitherSplit, ShowsARayEveryLeafItMayTouch)
{
    Random random(6);
    const auto boxes = random_boxes<float>(random, 3000);
    const Bvh<float> bvh = build(boxes, GetParam());
    std::size_t touched = 0, shown = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3f origin = to_float(random.direction() * 2.0);
        const Vec3f direction = to_float(random.in_box({-1, -1, -1}, {1, 1, 1})) - origin;
        const SlabRay<float> ray(origin, reciprocal(direction), 0);
        std::vector<bool> seen(boxes.size());
        traverse(bvh, ray, 0.0f, 100.0f, [&](std::uint32_t first, std::uint32_t count, float&) {
            for (std::uint32_t k = first; k < first + count; ++k)
                seen[bvh.order[k]] = true;
            shown += count;
            return false;
        });
        for (std::size_t k = 0; k < boxes.size(); ++k) {
            float entry = 0, exit = 0;
            if (!ray.meets(boxes[k].lower, boxes[k].upper, 0.0f, 100.0f, entry, exit)) continue;
            ++touched;
            ASSERT_TRUE(seen[k]);
        }
    }
    EXPECT_GT(touched, 500u);
    EXPECT_LT(shown, 2000u * 3000u / 10) << "and few others";
}

TEST(Bvh, BySurfaceAreaVisitsLessThanByMidpoint)
{
    // A dense clump and a few strays: what the heuristic is for.
    Random random(8);
    std::vector<Bounds3f> boxes;
    for (int i = 0; i < 5000; ++i) {
        const Vec3d at =
            i < 4900 ? random.direction() * 0.01 * random.uniform() : random.direction() * random.uniform();
        const double size = i < 4900 ? 0.0002 : 0.2;
        boxes.push_back({to_float(at), to_float(at + Vec3d{size, size, size})});
    }
    std::size_t visits[2] = {};
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint}) {
        const Bvh<float> bvh = build(boxes, split);
        Random rays(9);
        for (int i = 0; i < 2000; ++i) {
            const SlabRay<float> ray(
                to_float(rays.direction() * 2.0), reciprocal(to_float(rays.direction())), 0);
            traverse(bvh, ray, 0.0f, 100.0f, [&](std::uint32_t, std::uint32_t count, float&) {
                visits[split == BvhSplit::sah ? 0 : 1] += count;
                return false;
            });
        }
    }
    EXPECT_LT(visits[0], visits[1]);
}

} // namespace
