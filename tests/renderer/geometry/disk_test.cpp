#include "renderer/geometry/disk.h"

#include <gtest/gtest.h>

namespace {

using renderer::Disk;
using renderer::Ray;

TEST(Disk, IsHitWithinItsRadiusFromBothSides)
{
    const Disk disk{2};
    EXPECT_EQ(*intersect(disk, Ray{{1, 1, 3}, {0, 0, -1}}), 3);
    EXPECT_EQ(*intersect(disk, Ray{{1, 1, -3}, {0, 0, 2}}), 1.5);
    EXPECT_TRUE(intersect(disk, Ray{{2, 0, 3}, {0, 0, -1}})) << "its rim belongs to it";
    EXPECT_FALSE(intersect(disk, Ray{{2.0000001, 0, 3}, {0, 0, -1}}));
    EXPECT_FALSE(intersect(disk, Ray{{1.5, 1.5, 3}, {0, 0, -1}})) << "it is round";
}

TEST(Disk, KeepsTheRange)
{
    const Disk disk{2};
    EXPECT_FALSE(intersect(disk, Ray{{0, 0, 3}, {0, 0, 1}}));
    EXPECT_FALSE(intersect(disk, Ray{{0, 0, 3}, {0, 0, -1}, 0, 3}));
    EXPECT_FALSE(intersect(disk, Ray{{0, 0, 3}, {0, 0, -1}, 3, 9}));
    EXPECT_FALSE(intersect(disk, Ray{{0, 0, 0}, {0, 0, -1}})) << "a ray that starts on it";
    EXPECT_FALSE(intersect(disk, Ray{{-5, 0, 0}, {1, 0, 0}})) << "a ray in its plane";
    EXPECT_FALSE(intersect(disk, Ray{{-5, 0, 1}, {1, 0, -0.0}}));
}

TEST(Disk, TellsThePointAndItsSide)
{
    const renderer::SurfacePoint p = point_at(Disk{2}, Ray{{1, 0.5, 3}, {0, 0, -1}}, 3);
    EXPECT_EQ(p.position, (renderer::Vec3d{1, 0.5, 0}));
    EXPECT_EQ(p.normal, (renderer::Vec3d{0, 0, 1}));
    EXPECT_EQ(p.error.z, 0) << "z is exact";
    EXPECT_GT(p.error.x, 0);
}

} // namespace
