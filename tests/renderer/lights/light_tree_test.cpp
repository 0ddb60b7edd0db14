#include "renderer/lights/light_tree.h"
#include "renderer/sampling/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace renderer;

namespace {

LightBounds lamp(Vec3d at, double power, Vec3d axis = {0, 0, 1}, double cos_spread = -1)
{
    LightBounds b;
    b.box.extend(at);
    b.power = power;
    b.axis = axis;
    b.cos_spread = cos_spread;
    return b;
}

std::vector<LightBounds> many(std::size_t n)
{
    std::vector<LightBounds> lights;
    for (std::size_t i = 0; i < n; ++i) {
        const PixelSampler s(5, static_cast<std::uint32_t>(i), 0);
        const Sample2 u = s.sample_2d(0, 0), v = s.sample_2d(0, 1);
        lights.push_back(lamp(
            {10 * static_cast<double>(u.u0), 10 * static_cast<double>(u.u1), 10 * static_cast<double>(v.u0)},
            0.1 + static_cast<double>(v.u1)));
    }
    return lights;
}

} // namespace

TEST(LightTree, PicksWithTheProbabilityThatItTellsAndTheyAddUpToOne)
{
    const std::vector<LightBounds> lights = many(200);
    const LightTree tree(lights);
    for (const Vec3d& point : {Vec3d{5, 5, 5}, Vec3d{-3, 20, 1}, Vec3d{1, 1, 1}}) {
        double sum = 0;
        for (std::uint32_t i = 0; i < lights.size(); ++i)
            sum += tree.probability(point, i);
        EXPECT_NEAR(sum, 1, 1e-9);
        std::vector<int> picked(lights.size());
        constexpr int kDraws = 200000;
        for (int i = 0; i < kDraws; ++i) {
            const LightTree::Pick pick = tree.pick(point, (i + 0.5) / kDraws);
            ASSERT_NEAR(pick.probability, tree.probability(point, pick.light), 1e-9 * pick.probability);
            ++picked[pick.light];
        }
        for (std::uint32_t i = 0; i < lights.size(); ++i)
            EXPECT_NEAR(picked[i], kDraws * tree.probability(point, i), 2 + 1e-6 * kDraws) << i;
    }
}

TEST(LightTree, PrefersWhatIsNearAndStrong)
{
    const std::vector<LightBounds> lights{lamp({0, 0, 0}, 1), lamp({100, 0, 0}, 1), lamp({100, 1, 0}, 1000)};
    const LightTree tree(lights);
    EXPECT_GT(tree.probability({1, 0, 0}, 0), 0.9);
    EXPECT_GT(tree.probability({100, 0.5, 0}, 2), 0.9);
}

TEST(LightTree, NeverPicksWhatShinesTheOtherWay)
{
    const std::vector<LightBounds> lights{lamp({0, 1, 0}, 1, {0, -1, 0}, 1),
                                          lamp({1, 1, 0}, 1, {0, 1, 0}, 1)};
    const LightTree tree(lights);
    EXPECT_EQ(tree.probability({0, 0, 0}, 1), 0);
    EXPECT_EQ(tree.probability({0, 0, 0}, 0), 1);
    EXPECT_EQ(tree.pick({0, 1, 0.5}, 0.5).probability, 0) << "in the plane of both";
}

TEST(LightTree, ReachesOneStrongLightAmongAHundredThousand)
{
    std::vector<LightBounds> lights = many(100000);
    for (LightBounds& light : lights)
        light.power = 1e-6;
    lights[4711].power = 1;
    const LightTree tree(lights);
    const Vec3d point{5, 5, -30};
    EXPECT_GT(tree.probability(point, 4711), 0.5);
    for (const std::uint32_t i : {0u, 17u, 99999u})
        EXPECT_GT(tree.probability(point, i), 0);
}

TEST(LightTree, HasNothingToPickOfNoLightsAndOfBlackOnes)
{
    EXPECT_TRUE(LightTree().empty());
    EXPECT_TRUE(LightTree(std::vector{lamp({0, 0, 0}, 0)}).empty());
    EXPECT_EQ(LightTree().pick({0, 0, 0}, 0.5).probability, 0);
    const LightTree one(std::vector{lamp({0, 0, 0}, 0), lamp({1, 0, 0}, 2)});
    EXPECT_EQ(one.pick({5, 5, 5}, 0.9).light, 1u);
    EXPECT_EQ(one.probability({5, 5, 5}, 1), 1);
    EXPECT_EQ(one.probability({5, 5, 5}, 0), 0);
}

TEST(LightTree, TakesLightsInOnePlace)
{
    const LightTree tree(std::vector(33, lamp({1, 2, 3}, 1)));
    double sum = 0;
    for (std::uint32_t i = 0; i < 33; ++i)
        sum += tree.probability({1, 2, 3}, i);
    EXPECT_NEAR(sum, 1, 1e-9);
}
