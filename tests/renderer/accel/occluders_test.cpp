#include "renderer/accel/occluders.h"

#include <gtest/gtest.h>

using namespace renderer;

namespace {

RayFan fan_to(const Vec3d& apex)
{
    RayFan fan;
    fan.apex = apex;
    fan.reach = 1;
    return fan;
}

Occluders some(std::uint32_t leaf)
{
    Occluders occluders;
    occluders.add(leaf);
    return occluders;
}

} // namespace

TEST(Occluders, AreKeptOnceEachAndNoMoreThanAFew)
{
    Occluders occluders;
    for (const std::uint32_t leaf : {7u, 8u, 7u, 9u, 8u, 10u, 11u, 12u})
        occluders.add(leaf);
    ASSERT_EQ(occluders.count, Occluders::kMost);
    for (unsigned i = 0; i < occluders.count; ++i)
        EXPECT_EQ(occluders.leaves[i], 7 + i);
}

TEST(LastOccluders, AreToldOfAboutTheSameLightInTheSameMesh)
{
    const WideNode meshes[2] = {};
    LastOccluders last;
    last.put(&meshes[0], fan_to({1, 2, 3}), some(7));
    EXPECT_EQ(last.take(&meshes[1], fan_to({1, 2, 3})).count, 0u);
    EXPECT_EQ(last.take(&meshes[0], fan_to({1, 2, 3.01})).count, 0u);
    const Occluders taken = last.take(&meshes[0], fan_to({1, 2, 3 - 0x1p-20}));
    ASSERT_EQ(taken.count, 1u);
    EXPECT_EQ(taken.leaves[0], 7u);
}

TEST(LastOccluders, AreForgottenWhereTheNextFanIsNotHidden)
{
    const WideNode mesh{};
    LastOccluders last;
    last.put(&mesh, fan_to({1, 2, 3}), some(7));
    EXPECT_EQ(last.take(&mesh, fan_to({1, 2, 3})).count, 1u);
    EXPECT_EQ(last.take(&mesh, fan_to({1, 2, 3})).count, 0u);
}

TEST(LastOccluders, OfAFewLightsDoNotCrowdOutEachOther)
{
    const WideNode mesh{};
    LastOccluders last;
    for (std::uint32_t round = 0; round < 3; ++round)
        for (std::uint32_t light = 0; light < 4; ++light) {
            const RayFan fan = fan_to({double(light), 0, 0});
            const Occluders taken = last.take(&mesh, fan);
            ASSERT_EQ(taken.count, round == 0 ? 0u : 1u);
            if (round > 0) {
                EXPECT_EQ(taken.leaves[0], light);
            }
            last.put(&mesh, fan, some(light));
        }
}
