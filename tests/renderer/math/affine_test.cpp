#include "renderer/math/affine.h"

#include <gtest/gtest.h>

#include <cmath>

using renderer::Affine3;
using renderer::Vec3d;

namespace {

double distance(Vec3d a, Vec3d b)
{
    return length(a - b);
}

} // namespace

TEST(Affine3, AppliesTheInnerMapFirst)
{
    const Affine3 map = Affine3::translate({1, 2, 3}) * Affine3::scale({2, 2, 2});
    EXPECT_EQ(map.point({1, 1, 1}), (Vec3d{3, 4, 5}));
    EXPECT_EQ(map.vector({1, 1, 1}), (Vec3d{2, 2, 2}));
}

TEST(Affine3, TurnsRightHandedAndExactlyByRightAngles)
{
    EXPECT_EQ(Affine3::rotate_deg(90, {0, 0, 5}).point({1, 0, 0}), (Vec3d{0, 1, 0}));
    EXPECT_EQ(Affine3::rotate_deg(-90, {1, 0, 0}).point({0, 0, 1}), (Vec3d{0, 1, 0}));
    EXPECT_EQ(Affine3::rotate_deg(360, {0, 1, 0}).point({3, 4, 5}), (Vec3d{3, 4, 5}));
    EXPECT_LT(distance(Affine3::rotate_deg(120, {1, 1, 1}).point({1, 0, 0}), {0, 1, 0}), 1e-15);
}

TEST(Affine3, InverseUndoesAtEveryScale)
{
    for (const double size : {1e-150, 1e-6, 1.0, 1e6, 1e150}) {
        const Affine3 map = Affine3::translate({size, -2 * size, 3 * size}) *
                            Affine3::rotate_deg(33, {1, 2, 3}) * Affine3::scale({size, 2 * size, -3 * size});
        const auto inverse = map.inverse();
        ASSERT_TRUE(inverse) << size;
        EXPECT_LT(distance(inverse->point(map.point({0.25, 0.5, 0.75})), {0.25, 0.5, 0.75}), 1e-12) << size;
    }
}

TEST(Affine3, InvertsALargeShearAndRefusesACollapsedVolume)
{
    Affine3 shear;
    shear.rows[0] = {1, 1e6, 0};
    ASSERT_TRUE(shear.inverse());
    EXPECT_LT(distance(shear.inverse()->point(shear.point({1, 2, 3})), {1, 2, 3}), 1e-8);
    EXPECT_FALSE(Affine3::scale({1, 0, 1}).inverse());
    Affine3 flat;
    flat.rows[2] = flat.rows[0] + flat.rows[1];
    EXPECT_FALSE(flat.inverse());
    EXPECT_FALSE(Affine3::scale({1, std::nan(""), 1}).inverse());
}

TEST(Affine3, DeterminantIsNegativeForAMirror)
{
    EXPECT_EQ(Affine3::scale({-1, 1, 1}).determinant(), -1);
    EXPECT_EQ(Affine3::scale({2, 3, 4}).determinant(), 24);
}

TEST(Vec3, LengthNeitherUnderflowsNorOverflows)
{
    EXPECT_DOUBLE_EQ(length(Vec3d{3e-300, 4e-300, 0}), 5e-300);
    EXPECT_DOUBLE_EQ(length(Vec3d{3e300, 0, 4e300}), 5e300);
    EXPECT_DOUBLE_EQ(normalize(Vec3d{0, -1e-310, 0}).y, -1);
    EXPECT_EQ(length(Vec3d{0, 0, 0}), 0);
}
