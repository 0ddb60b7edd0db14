#include "renderer/geometry/surface_point.h"
#include "renderer/geometry/triangle.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace renderer;
using random_scenes::Random;

using tests::kThinning;

TEST(OffsetOrigin, LeavesOnTheSideOfTheDirection)
{
    const SurfacePoint p{{1, 2, 3}, {1e-15, 1e-15, 1e-15}, {0, 1, 0}};
    EXPECT_GT(offset_origin(p, {5, 0.1, 0}).y, 2);
    EXPECT_LT(offset_origin(p, {5, -0.1, 0}).y, 2);
    EXPECT_LT(std::abs(offset_origin(p, {5, -0.1, 0}).y - 2), 1e-14) << "no farther than rounding asks";
    EXPECT_EQ(offset_origin(p, {5, 1, 0}).x, 1);
}

TEST(OffsetOrigin, HasNoLengthOfItsOwn)
{
    // At the world's origin an offset in ulps of the coordinate would vanish; a constant would be wrong at
    // some scale.
    const SurfacePoint at_zero{{0, 0, 0}, {1e-30, 1e-30, 1e-30}, {0, 0, 1}};
    const double z = offset_origin(at_zero, {0, 0, 1}).z;
    EXPECT_GE(z, 1e-30);
    EXPECT_LE(z, 1.1e-30);
}

// Leaving 1000 random triangles, coordinates 10^U(-8, 8), in 1000 directions and towards 1000 targets.
TEST(TrianglePoint, IsNeverHitAgainByARayThatLeavesIt)
{
    Random random(4);
    int left = 0;
    for (int i = 0; i < 1000 / kThinning; ++i) {
        const auto corner = [&] {
            return to_float({random.exponential(8), random.exponential(8), random.exponential(8)});
        };
        const Vec3f a = corner(), b = corner(), c = corner();
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const Vec3d aim = to_double(a) * (1 - u - v) + to_double(b) * u + to_double(c) * v;
        Ray ray;
        ray.origin = {random.exponential(8), random.exponential(8), random.exponential(8)};
        ray.direction = aim - ray.origin;
        const auto hit = intersect_watertight(ray, to_double(a), to_double(b), to_double(c));
        if (!hit) continue;
        ++left;
        const SurfacePoint point =
            triangle_point(to_double(a), to_double(b), to_double(c), hit->barycentrics);
        for (int k = 0; k < 1000; ++k) {
            Ray next;
            next.direction = random.direction();
            next.origin = offset_origin(point, next.direction);
            ASSERT_FALSE(intersect_watertight(next, to_double(a), to_double(b), to_double(c)))
                << i << ' ' << k;
            const Vec3d target{random.exponential(8), random.exponential(8), random.exponential(8)};
            next.origin = offset_origin(point, target - point.position);
            next.direction = target - next.origin;
            next.t_max = 1;
            ASSERT_FALSE(intersect_watertight(next, to_double(a), to_double(b), to_double(c)))
                << i << ' ' << k;
        }
    }
    EXPECT_GT(left, 800 / kThinning);
}

TEST(TrianglePoint, LiesWithinItsErrorOfThePlane)
{
    Random random(5);
    for (int i = 0; i < 20000; ++i) {
        const double scale = std::pow(10, random.uniform(-6, 6));
        const Vec3f a = to_float(random.direction() * scale), b = to_float(random.direction() * scale),
                    c = to_float(random.direction() * scale);
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const SurfacePoint p = triangle_point(to_double(a), to_double(b), to_double(c), {1 - u - v, u, v});
        // Distance to the plane in long double, against the bound along the normal.
        const Vec3d ab = to_double(b) - to_double(a), ac = to_double(c) - to_double(a);
        const auto term = [](double x, double y, double z, double w) {
            return static_cast<long double>(x) * y - static_cast<long double>(z) * w;
        };
        const long double nx = term(ab.y, ac.z, ab.z, ac.y), ny = term(ab.z, ac.x, ab.x, ac.z),
                          nz = term(ab.x, ac.y, ab.y, ac.x);
        const long double n_length = std::sqrt(nx * nx + ny * ny + nz * nz);
        const long double off = (nx * (static_cast<long double>(p.position.x) - a.x) +
                                 ny * (static_cast<long double>(p.position.y) - a.y) +
                                 nz * (static_cast<long double>(p.position.z) - a.z)) /
                                n_length;
        ASSERT_LE(static_cast<double>(std::abs(off)), dot(abs(p.normal), p.error));
        ASSERT_LE(length(p.error), 1e-14 * scale) << "the bound is not wasteful";
    }
}

} // namespace
