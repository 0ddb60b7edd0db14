#include "renderer/geometry/box.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace {

using namespace renderer;
using random_scenes::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Bounds3d kUnitBox{{0, 0, 0}, {1, 1, 1}};

// The truth by cases: exact comparisons, no division where the direction is zero.
bool hits_by_cases(const Bounds3d& box, const Ray& ray)
{
    double entry = ray.t_min, exit = ray.t_max;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double o = ray.origin[axis], d = ray.direction[axis];
        if (d == 0) {
            if (o < box.lower[axis] || o > box.upper[axis]) return false;
            continue;
        }
        const double a = (box.lower[axis] - o) / d, b = (box.upper[axis] - o) / d;
        entry = std::max(entry, std::min(a, b));
        exit = std::min(exit, std::max(a, b));
    }
    return entry <= exit;
}

TEST(Box, IsMetFromInsideAndFromItsFaces)
{
    const auto from_inside = intersect_box(kUnitBox, Ray{{0.5, 0.5, 0.5}, {1, 2, 3}});
    ASSERT_TRUE(from_inside);
    EXPECT_EQ(from_inside->entry, 0);
    EXPECT_NEAR(from_inside->exit, 0.5 / 3, 1e-15);
    for (const Vec3d direction : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{-0.0, -1, 0}})
        EXPECT_TRUE(intersect_box(kUnitBox, Ray{{0, 0.5, 0.5}, direction})) << "origin on a face";
    EXPECT_FALSE(intersect_box(kUnitBox, Ray{{2, 0.5, 0.5}, {1, 0, 0}})) << "the box is behind";
    EXPECT_FALSE(intersect_box(kUnitBox, Ray{{-1, 0.5, 0.5}, {1, 0, 0}, 0, 0.5})) << "the range ends before";
    EXPECT_FALSE(intersect_box(kUnitBox, Ray{{-1, 0.5, 0.5}, {1, 0, 0}, 2.5})) << "the range begins after";
}

TEST(Box, KeepsItsHitsUnderEverySignOfZero)
{
    // Lattice points put origins exactly on slab planes, where 0 * infinity lurks.
    const std::array<double, 5> places{-1, 0, 0.5, 1, 2};
    const std::array<double, 4> steps{0.0, -0.0, 1, -1};
    int hits = 0, rays = 0;
    for (double ox : places)
        for (double oy : places)
            for (double oz : places)
                for (double dx : steps)
                    for (double dy : steps)
                        for (double dz : steps) {
                            const Ray ray{{ox, oy, oz}, {dx, dy, dz}};
                            if (!is_traceable(ray)) continue;
                            ++rays;
                            const bool expected = hits_by_cases(kUnitBox, ray);
                            EXPECT_TRUE(!expected || intersect_box(kUnitBox, ray))
                                << ox << ' ' << oy << ' ' << oz << " towards " << dx << ' ' << dy << ' '
                                << dz;
                            const bool far_off =
                                ox * ox + oy * oy + oz * oz > 3.5 && dx * ox + dy * oy + dz * oz >= 0;
                            EXPECT_FALSE(far_off && !expected && intersect_box(kUnitBox, ray));
                            hits += expected;
                        }
    EXPECT_GT(hits, rays / 4);
}

TEST(Box, IsNeverLostByRounding)
{
    Random random(3);
    int hits = 0;
    for (int i = 0; i < 200000; ++i) {
        Bounds3d box;
        box.extend(random.in_box({-1, -1, -1}, {1, 1, 1}));
        if (random.below(4) != 0) box.extend(random.in_box({-1, -1, -1}, {1, 1, 1})); // else a point box
        if (random.below(3) == 0) box.upper.y = box.lower.y;                          // flat
        // A point of the box that the ray goes through but for rounding.
        Vec3d p = random.in_box(box.lower, box.upper);
        if (random.below(2)) p[random.below(3)] = box.upper[0];
        p = {std::clamp(p.x, box.lower.x, box.upper.x),
             std::clamp(p.y, box.lower.y, box.upper.y),
             std::clamp(p.z, box.lower.z, box.upper.z)};
        Ray ray;
        ray.origin = p + random.direction();
        ray.direction = p - ray.origin;
        // The ray's own rounding is the caller's: it says by how much boxes are to be met enlarged.
        const SlabRay<double> slabs(ray.origin, reciprocal(ray.direction), 4e-16);
        double entry = 0, exit = 0;
        ASSERT_TRUE(slabs.meets(box.lower, box.upper, 0, kInfinity, entry, exit)) << i;
        ASSERT_LE(entry, 1.0 + 1e-14);
        ++hits;
    }
    EXPECT_EQ(hits, 200000);
}

TEST(Box, KeepsFlatAndPointBoxes)
{
    const Bounds3d flat{{0, 0.25, 0}, {1, 0.25, 1}}, point{{0.3, 0.3, 0.3}, {0.3, 0.3, 0.3}};
    EXPECT_TRUE(intersect_box(flat, Ray{{0.5, 3, 0.5}, {0, -1, 0}}));
    EXPECT_TRUE(intersect_box(flat, Ray{{-1, 0.25, 0.5}, {1, 0, 0}})) << "within the plane";
    EXPECT_TRUE(intersect_box(point, Ray{{0.3, 0.3, -5}, {0, 0, 1}}));
    EXPECT_TRUE(intersect_box(point, Ray{{0.3, 0.3, 0.3}, {1, 1, 1}})) << "from the point itself";
    EXPECT_FALSE(intersect_box(point, Ray{{0.30001, 0.3, -5}, {0, 0, 1}}));
    EXPECT_FALSE(intersect_box(Bounds3d{}, Ray{{0, 0, 0}, {0, 0, 1}})) << "an empty box contains nothing";
}

TEST(Box, IsMissedByRaysThatAreNoRays)
{
    for (const double bad : {kNan, kInfinity, -kInfinity})
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Ray ray{{0.5, 0.5, 0.5}, {1, 1, 1}};
            ray.origin[axis] = bad;
            EXPECT_FALSE(intersect_box(kUnitBox, ray));
            ray = {{0.5, 0.5, 0.5}, {1, 1, 1}};
            ray.direction[axis] = bad;
            EXPECT_FALSE(intersect_box(kUnitBox, ray));
        }
    EXPECT_FALSE(intersect_box(kUnitBox, Ray{{0.5, 0.5, 0.5}, {0, 0, 0}}));
    EXPECT_FALSE(intersect_box(kUnitBox, Ray{{0.5, 0.5, 0.5}, {1, 0, 0}, kNan}));
    EXPECT_FALSE(intersect_box(kUnitBox, Ray{{0.5, 0.5, 0.5}, {1, 0, 0}, 0, kNan}));
    EXPECT_FALSE(intersect_box(kUnitBox, Ray{{0.5, 0.5, 0.5}, {1, 0, 0}, 1, 1})) << "an empty range";
    EXPECT_TRUE(intersect_box(kUnitBox, Ray{{0.5, 0.5, 0.5}, {1e-300, 0, 0}}));
    EXPECT_TRUE(intersect_box(kUnitBox, Ray{{0.5, 0.5, 0.5}, {1e300, 0, 0}}));
}

} // namespace
