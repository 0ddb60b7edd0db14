// Where rays meet placed objects, and how they leave again.
#include "renderer/geometry/shapes.h"
#include "tests/renderer/accel/placed_objects.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace renderer;
using random_scenes::Random;

using tests::kThinning;

TEST(Instance, IsNotPlacedByATransformThatCollapsesIt)
{
    EXPECT_FALSE(Instance::place(Sphere{1}, Affine3::scale({1, 0, 1})));
    Affine3 flat;
    flat.rows[2] = flat.rows[1];
    EXPECT_FALSE(Instance::place(Sphere{1}, flat));
    EXPECT_TRUE(Instance::place(Sphere{1}, Affine3::scale({1, -1e-6, 1})));
}

// Leaves each hit in random directions, outwards and inwards. Convex shapes are not hit again from outside;
// from inside the far side is hit, and not the near one.
void expect_clean_departures(const InstanceTree& tree, Random& random, Vec3d center, double size, int rays)
{
    int departures = 0;
    for (int i = 0; i < rays; ++i) {
        const Vec3d origin = center + random.direction() * (size * 4);
        const auto hit = tree.closest_hit({origin, center + random.direction() * (size * 0.4) - origin});
        if (!hit) continue;
        for (int k = 0; k < 10; ++k) {
            const Vec3d direction = random.direction();
            const Ray next{offset_origin(hit->point, direction), direction};
            const bool outwards = dot(direction, hit->point.normal) > 0;
            const auto again = tree.closest_hit(next);
            if (outwards) {
                ASSERT_FALSE(again) << "acne at size " << size << ", t " << again->t;
                ASSERT_FALSE(tree.any_hit(next));
            } else {
                ASSERT_TRUE(again) << "a leak at size " << size;
                // On the far side, where the ray leaves the shape.
                ASSERT_GT(dot(direction, again->point.normal), 0);
                ASSERT_LT(length(again->point.position - center), size * 2);
            }
            ++departures;
        }
    }
    EXPECT_GT(departures, rays * 5);
}

TEST(SceneHit, CanBeLeftAtEveryScale)
{
    Random random(6);
    for (const double size : {1e-6, 1e-3, 1., 1e3, 1e6})
        for (int i = 0; i < 8; ++i) {
            Objects objects;
            const Affine3 turned =
                Affine3::rotate_deg(i < 2 ? 0 : random.uniform(0, 360), random.direction());
            // Some with a face through the world's origin, some far away, some around it.
            const Vec3d at = i % 4 == 0   ? turned.vector({0, size * 0.5, 0})
                             : i % 4 == 1 ? random.direction() * (size * 1e3)
                                          : Vec3d{};
            const Affine3 placed = Affine3::translate(at) * turned * Affine3::scale({size, size, size});
            i % 2 == 0 ? objects.add(unit_box(), placed) : objects.add(Sphere{0.5}, placed);
            expect_clean_departures(objects.tree(), random, at, size * 0.5, 600 / kThinning);
        }
}

TEST(SceneHit, CanBeLeftAtTheOriginItself)
{
    // The point of the hit is exactly 0, where an offset of a few ulps of the coordinate vanishes.
    for (const double size : {1e-6, 1., 1e6}) {
        Objects objects;
        objects.add(unit_box(), Affine3::translate({0, -size / 2, 0}) * Affine3::scale({size, size, size}));
        const InstanceTree tree = objects.tree();
        const auto hit = tree.closest_hit({{size, 2 * size, size / 3}, {-size, -2 * size, -size / 3}});
        ASSERT_TRUE(hit);
        ASSERT_LT(length(hit->point.position), 1e-12 * size);
        Random random(61);
        for (int i = 0; i < 2000; ++i) {
            const Vec3d direction = random.direction();
            EXPECT_EQ(tree.any_hit({offset_origin(hit->point, direction), direction}), direction.y < 0);
        }
    }
}

// A millimetre on a plane of a thousand kilometres: neither shadows itself, nor does the plane reach up to
// it.
TEST(SceneHit, CanBeLeftInASceneOfManySizes)
{
    Random random(3);
    Objects objects;
    objects.add(random_scenes::grid(10, 1e6), {});
    const double size = 1e-3;
    const Vec3d at{0.3, size, 0.7};
    objects.add(unit_box(),
                Affine3::translate(at) * Affine3::rotate_deg(33, {1, 2, 3}) *
                    Affine3::scale({size, size, size}));
    const InstanceTree tree = objects.tree();
    int shadow_rays = 0;
    for (int i = 0; i < 250000 / kThinning; ++i) {
        Vec3d from = random.direction() * 1e-2;
        from.y = std::abs(from.y);
        const Vec3d origin = at + from;
        const auto hit = tree.closest_hit({origin, at + random.direction() * (0.4 * size) - origin});
        if (!hit || hit->instance != 1) continue;
        for (int k = 0; k < 10; ++k) {
            Vec3d direction = random.direction();
            direction.y = std::abs(direction.y); // the plane is below
            if (dot(direction, hit->point.normal) <= 0) continue;
            ++shadow_rays;
            ASSERT_FALSE(tree.any_hit({offset_origin(hit->point, direction), direction})) << i;
        }
    }
    EXPECT_GT(shadow_rays, 1000000 / kThinning);
}

TEST(SceneHit, OfSpheresDisksAndRectanglesIsNeverHitAgain)
{
    Random random(5);
    int departures = 0;
    for (int i = 0; i < 1000 / kThinning; ++i) {
        Objects objects;
        const double radius = std::abs(random.exponential(4));
        const Affine3 placed = random_placing(random, radius * 10);
        switch (i % 3) {
        case 0:
            objects.add(Sphere{radius}, placed);
            break;
        case 1:
            objects.add(Disk{radius}, placed);
            break;
        default:
            objects.add(unit_rectangle(), placed * Affine3::scale({radius, radius, radius}));
        }
        const InstanceTree tree = objects.tree();
        const Vec3d origin = placed.point(random.direction() * (3 * radius));
        const Vec3d aim = placed.point(random.direction() * (0.2 * radius));
        const auto hit = tree.closest_hit({origin, aim - origin});
        if (!hit) continue;
        for (int k = 0; k < 1000; ++k) {
            const Vec3d direction = random.direction();
            const bool outwards = dot(direction, hit->point.normal) > 0;
            if (i % 3 == 0 && !outwards) continue; // a sphere is met from inside
            ++departures;
            ASSERT_FALSE(tree.any_hit({offset_origin(hit->point, direction), direction})) << i << ' ' << k;
            // And as far as some place there.
            const Vec3d target = hit->point.position + direction * std::abs(radius * random.exponential(4));
            const Vec3d origin_there = offset_origin(hit->point, target - hit->point.position);
            ASSERT_FALSE(tree.any_hit({origin_there, target - origin_there, 0, 1})) << i << ' ' << k;
        }
    }
    EXPECT_GT(departures, 300000 / kThinning);
}

} // namespace
