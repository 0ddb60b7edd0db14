#include "renderer/accel/triangle_part.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace {

using namespace renderer;
using random_scenes::Random;

bool holds(const Bounds3f& box, Vec3d p)
{
    const Vec3d l = to_double(box.lower), u = to_double(box.upper);
    return l.x <= p.x && p.x <= u.x && l.y <= p.y && p.y <= u.y && l.z <= p.z && p.z <= u.z;
}

} // namespace

// Of all sizes, along the axes too, cut by planes through it, beside it and through its corners.
TEST(TrianglePart, HoldsEveryPointBetweenThePlanes)
{
    Random random(3);
    int between = 0;
    for (int i = 0; i < 20000; ++i) {
        const double size = std::abs(random.exponential(6));
        Vec3d corners[3];
        for (Vec3d& corner : corners)
            corner = to_double(to_float(random.in_box({-1, -1, -1}, {1, 1, 1}) * size));
        if (i % 7 == 0) corners[1].y = corners[0].y;
        const unsigned axis = random.below(3);
        auto from = static_cast<float>(random.uniform(-1, 1) * size);
        auto to = static_cast<float>(random.uniform(-1, 1) * size);
        if (i % 5 == 0) from = static_cast<float>(corners[random.below(3)][axis]);
        if (i % 11 == 0) to = std::numeric_limits<float>::infinity();
        if (to < from) std::swap(from, to);
        const Bounds3f box = part_between(corners, axis, from, to);
        for (int k = 0; k < 20; ++k) {
            const double a = random.uniform(), b = random.uniform() * (1 - a);
            const Vec3d p = corners[0] * a + corners[1] * b + corners[2] * (1 - a - b);
            // Where the point is off by its own rounding it may be on the other side.
            const double slack = size * 0x1p-50;
            if (p[axis] < static_cast<double>(from) + slack || p[axis] > static_cast<double>(to) - slack)
                continue;
            ++between;
            ASSERT_FALSE(box.empty());
            Vec3d nearer = p;
            for (unsigned x = 0; x < 3; ++x)
                nearer[x] = p[x] > box.center()[x] ? p[x] - slack : p[x] + slack;
            ASSERT_TRUE(holds(box, nearer)) << i;
        }
    }
    EXPECT_GT(between, 50000);
}

TEST(TrianglePart, IsNoLargerThanItNeedsToBe)
{
    const Vec3d corners[3] = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}};
    const Bounds3f box = part_between(corners, 0, 2, 4);
    EXPECT_EQ(box.lower.x, 2);
    EXPECT_EQ(box.upper.x, 4);
    EXPECT_NEAR(box.lower.y, 0, 1e-6);
    EXPECT_NEAR(box.upper.y, 6, 1e-5);
    EXPECT_NEAR(box.upper.z, 0, 1e-6);
}

TEST(TrianglePart, IsEmptyWhereThePlanesPassBeside)
{
    const Vec3d corners[3] = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}};
    EXPECT_TRUE(part_between(corners, 2, 1, 2).empty());
    EXPECT_TRUE(part_between(corners, 0, -3, -1).empty());
    EXPECT_FALSE(part_between(corners, 0, -3, 0).empty()) << "a plane through an edge counts";
}
