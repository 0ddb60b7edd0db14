// The upper level from one frame of an animation to the next.
#include "renderer/accel/instance_tree.h"
#include "renderer/geometry/shapes.h"
#include "tests/renderer/accel/placed_objects.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stop_token>

namespace {

using namespace renderer;
using random_scenes::Random;

using tests::kThinning;

// The greatest number of which `holds`, which holds of smaller ones, to a thousandth.
template <typename Holds>
double greatest(double low, double high, Holds&& holds)
{
    EXPECT_TRUE(holds(low) && !holds(high));
    while (high > 1.001 * low) {
        const double middle = std::sqrt(low * high);
        (holds(middle) ? low : high) = middle;
    }
    return low;
}

} // namespace

TEST(InstanceTree, FindsTheSameHitsInATreeThatWasRefitted)
{
    Random random(11);
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint})
        for (const std::size_t count : {2u, 3u, 40u, 300u}) {
            Objects objects;
            while (objects.size() < count) {
                const Affine3 placed = random_placing(random, 3);
                objects.add(unit_box(), placed, objects.size() % 5 != 0); // some hidden from the camera
            }
            BvhTopologyCache trees;
            const EarlierFrames earlier{&trees, 1e-3}; // so few rays are worth no building
            EXPECT_EQ(objects.tree(split, earlier).upper_level(), UpperLevel::built);
            for (const double by : {0.0, 0.01, 1.0, 30.0}) {
                for (std::size_t i = 0; i < objects.size(); i += 2)
                    objects.move(i, Affine3::translate(random.direction() * by));
                const InstanceTree refitted = objects.tree(split, earlier), built = objects.tree(split);
                ASSERT_EQ(refitted.upper_level(), UpperLevel::refitted);
                ASSERT_EQ(built.upper_level(), UpperLevel::built);
                EXPECT_EQ(refitted.bounds(), built.bounds());
                EXPECT_EQ(refitted.size_bytes(), built.size_bytes());
                for (int i = 0; i < 2000 / kThinning; ++i) {
                    Ray rays[4];
                    for (Ray& ray : rays)
                        ray = {random.direction() * random.uniform(0, 20), random.direction()};
                    const RayKind kind = i % 2 == 0 ? RayKind::camera : RayKind::other;
                    SceneHit hits[4];
                    const std::uint64_t hit = refitted.closest_hits(rays, hits, kind),
                                        met = refitted.any_hits(rays, kind);
                    for (unsigned r = 0; r < 4; ++r) {
                        const auto expected = built.closest_hit_brute_force(rays[r], kind);
                        const auto alone = refitted.closest_hit(rays[r], kind);
                        ASSERT_EQ((hit >> r & 1) != 0, expected.has_value());
                        ASSERT_EQ((met >> r & 1) != 0, expected.has_value());
                        ASSERT_EQ(alone.has_value(), expected.has_value());
                        if (!expected) continue;
                        for (const SceneHit& found : {hits[r], *alone}) {
                            ASSERT_EQ(found.t, expected->t);
                            ASSERT_EQ(found.instance, expected->instance);
                            ASSERT_EQ(found.primitive, expected->primitive);
                        }
                    }
                }
            }
        }
}

TEST(InstanceTree, IsBuiltAnewWhereRaysWouldLoseMoreInAnOldOneThanThatTakes)
{
    Random random(12);
    Objects objects;
    while (objects.size() < 200)
        objects.add(Sphere{0.1}, Affine3::translate(random.in_box({-5, -5, -5}, {5, 5, 5})));
    BvhTopologyCache trees;
    objects.tree(BvhSplit::sah, {&trees, 1e6});
    objects.tree(BvhSplit::sah, {&trees, 1e6});
    EXPECT_EQ(objects.tree(BvhSplit::sah, {&trees, 1e12}).upper_level(), UpperLevel::refitted); // the same
    for (std::size_t i = 0; i < objects.size(); ++i)
        objects.move(i, Affine3::translate(random.direction()));
    EXPECT_EQ(objects.tree(BvhSplit::sah, {&trees, 10}).upper_level(), UpperLevel::refitted);
    EXPECT_EQ(objects.tree(BvhSplit::sah, {&trees, 1e6}).upper_level(), UpperLevel::built);
    EXPECT_EQ(objects.tree(BvhSplit::sah, {&trees, 1e6}).upper_level(), UpperLevel::refitted); // that one
}

TEST(InstanceTree, WeighsBuildingOneOfItsInstancesAsSomeDozensOfVisits)
{
    constexpr std::size_t kCount = 200;
    const auto frame = [](int number, const EarlierFrames& earlier) {
        Random random(14);
        Objects objects;
        while (objects.size() < kCount) {
            const Vec3d there = random.in_box({-5, -5, -5}, {5, 5, 5}), by = random.direction() * 0.5;
            objects.add(Sphere{0.1}, Affine3::translate(there + by * number));
        }
        return objects.tree(BvhSplit::sah, earlier);
    };
    const double rays = greatest(1, 1e9, [&](double number) {
        BvhTopologyCache trees;
        frame(0, {&trees, number});
        return frame(1, {&trees, number}).upper_level() == UpperLevel::refitted;
    });

    ThreadPool pool(1);
    const auto boxes = [&](int number) {
        PlainArray<BuildItem<double>> items(kCount);
        const InstanceTree tree = frame(number, {});
        for (std::uint32_t i = 0; i < kCount; ++i) {
            const Bounds3d box = tree.instances()[i].world_bounds();
            items[i] = {box.lower, i, box.upper};
        }
        return items;
    };
    const BvhTopology topology(*build_bvh<double>(boxes(0), {.leaf_size = 1}, pool), kCount);
    const PlainArray<BuildItem<double>> there = boxes(1);
    const double too_few = greatest(1e-9, 1e9, [&](double more) {
        return !topology.refit({there.data(), there.size()}, more, pool).has_value();
    });
    const double visits_an_instance = rays * too_few / kCount;
    EXPECT_GT(visits_an_instance, 20);
    EXPECT_LT(visits_an_instance, 80);
}

TEST(InstanceTree, IsBuiltAnewOverObjectsOfOtherKinds)
{
    BvhTopologyCache trees;
    const auto level_with_disk_at = [&trees](unsigned place) {
        Objects objects;
        for (unsigned i = 0; i < 20; ++i) {
            const Affine3 there = Affine3::translate({1.0 * i, 0, 0});
            if (i == place)
                objects.add(Disk{0.3}, there);
            else
                objects.add(Sphere{0.3}, there);
        }
        return objects.tree(BvhSplit::sah, {&trees, 1e-3}).upper_level(); // so few rays are worth no building
    };
    EXPECT_EQ(level_with_disk_at(3), UpperLevel::built);
    EXPECT_EQ(level_with_disk_at(3), UpperLevel::refitted);
    EXPECT_EQ(level_with_disk_at(4), UpperLevel::built);
    EXPECT_EQ(level_with_disk_at(20), UpperLevel::built); // none
    EXPECT_EQ(level_with_disk_at(3), UpperLevel::refitted);
}

TEST(InstanceTree, LeavesNothingBehindOnceAStopIsRequested)
{
    Objects objects;
    for (int i = 0; i < 3; ++i)
        objects.add(Sphere{0.3}, Affine3::translate({1.0 * i, 0, 0}));
    std::stop_source stop;
    stop.request_stop();
    BvhTopologyCache trees;
    EXPECT_EQ(objects.tree(BvhSplit::sah, {&trees, 1}, stop.get_token()).upper_level(), UpperLevel::none);
    EXPECT_EQ(trees.size_bytes(), 0u);
}

TEST(InstanceTree, HasNoUpperLevelOverASingleObject)
{
    Objects objects;
    objects.add(Sphere{1}, Affine3{});
    BvhTopologyCache trees;
    EXPECT_EQ(objects.tree(BvhSplit::sah, {&trees, 1}).upper_level(), UpperLevel::none);
    EXPECT_EQ(objects.tree(BvhSplit::sah, {&trees, 1}).upper_level(), UpperLevel::none);
    EXPECT_EQ(trees.size_bytes(), 0u);
    objects.add(Sphere{1}, Affine3::translate({3, 0, 0}));
    EXPECT_EQ(objects.list(false).upper_level(), UpperLevel::none);
}
