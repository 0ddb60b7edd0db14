#include "renderer/accel/instance_tree.h"
#include "renderer/accel/prepared_mesh.h"
#include "renderer/geometry/shapes.h"
#include "tests/renderer/accel/placed_objects.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace {

using namespace renderer;
using random_scenes::Random;

using tests::kThinning;

void add_random(Objects& objects, Random& random, double spread)
{
    const Affine3 placed = random_placing(random, spread);
    switch (random.below(5)) {
    case 0:
        objects.add(unit_box(), placed);
        break;
    case 1:
        objects.add(unit_rectangle(), placed);
        break;
    case 2:
        objects.add(Sphere{random.uniform(0.2, 1)}, placed);
        break;
    case 3:
        objects.add(Disk{random.uniform(0.2, 1)}, placed);
        break;
    default:
        objects.add(random_scenes::soup(random, 20, 0.5, 0.5), placed);
    }
}

TEST(InstanceTree, FindsTheSameHitAsBruteForce)
{
    Random random(1);
    int hits = 0;
    for (const int count : {1, 2, 3, 10, 100}) {
        Objects objects;
        for (int i = 0; i < count; ++i)
            add_random(objects, random, 3);
        const InstanceTree sah = objects.tree(), midpoint = objects.tree(BvhSplit::midpoint),
                           list = objects.list(false), boxes = objects.list(true);
        for (int i = 0; i < 5000 / kThinning; ++i) {
            const Vec3d origin = random.direction() * random.uniform(0, 20);
            Ray ray{origin, random.in_box({-3, -3, -3}, {3, 3, 3}) - origin};
            if (random.below(4) == 0) ray.t_max = random.uniform(0, 1);
            const auto expected = sah.closest_hit_brute_force(ray);
            for (const InstanceTree* tree : {&sah, &midpoint, &list, &boxes}) {
                const auto hit = tree->closest_hit(ray);
                ASSERT_EQ(hit.has_value(), expected.has_value());
                ASSERT_EQ(tree->any_hit(ray), expected.has_value());
                if (!hit) continue;
                ASSERT_EQ(hit->t, expected->t);
                ASSERT_EQ(hit->instance, expected->instance);
                ASSERT_EQ(hit->primitive, expected->primitive);
                ASSERT_EQ(hit->point.position, expected->point.position);
            }
            hits += expected.has_value();
        }
    }
    EXPECT_GT(hits, 5000 / kThinning);
}

TEST(InstanceTree, AnswersARunAsItsRaysOneByOne)
{
    Random random(3);
    int hits = 0;
    for (const int count : {1, 2, 30}) {
        Objects objects;
        for (int i = 0; i < count; ++i)
            add_random(objects, random, 3);
        const InstanceTree tree = objects.tree(), list = objects.list(false), boxes = objects.list(true);
        for (int i = 0; i < 300 / kThinning; ++i) {
            Ray rays[InstanceTree::kMostRays];
            for (Ray& ray : rays) {
                ray.origin = random.direction() * random.uniform(0, 20);
                ray.direction = random.in_box({-3, -3, -3}, {3, 3, 3}) - ray.origin;
                if (random.below(4) == 0) ray.t_max = random.uniform(0, 1);
                if (random.below(9) == 0) ray.direction = {};
            }
            const std::size_t size = 1 + random.below(InstanceTree::kMostRays);
            for (const InstanceTree* asked : {&tree, &list, &boxes}) {
                SceneHit found[InstanceTree::kMostRays];
                const std::uint64_t hit = asked->closest_hits({rays, size}, found),
                                    met = asked->any_hits({rays, size});
                for (std::size_t r = 0; r < size; ++r) {
                    const auto expected = tree.closest_hit_brute_force(rays[r]);
                    ASSERT_EQ((hit >> r & 1) != 0, expected.has_value());
                    ASSERT_EQ((met >> r & 1) != 0, expected.has_value());
                    if (!expected) continue;
                    ASSERT_EQ(found[r].t, expected->t);
                    ASSERT_EQ(found[r].instance, expected->instance);
                    ASSERT_EQ(found[r].primitive, expected->primitive);
                    ++hits;
                }
                ASSERT_EQ((hit | met) >> (size - 1) >> 1, 0u);
            }
        }
    }
    EXPECT_GT(hits, 300 / kThinning);
}

// Rays that run alike, a few that stray from them, and rays that have nothing in common.
std::vector<Ray> run_of_rays(Random& random, int kind)
{
    const Vec3d eye = random.direction() * random.uniform(2, 20),
                target = random.in_box({-3, -3, -3}, {3, 3, 3});
    std::vector<Ray> rays;
    for (unsigned i = 0; i < InstanceTree::kMostRays; ++i) {
        const bool strays = kind == 2 || (kind == 1 && i % 5 == 0);
        const Vec3d origin = strays ? random.direction() * random.uniform(0, 20) : eye;
        const Vec3d at = strays ? random.in_box({-3, -3, -3}, {3, 3, 3})
                                : target + random.in_box({-.1, -.1, -.1}, {.1, .1, .1});
        Ray ray{origin, at - origin};
        if (random.below(8) == 0) ray.t_max = random.uniform(0, 1);
        if (random.below(16) == 0) ray.direction = {}; // no ray
        rays.push_back(ray);
    }
    return rays;
}

TEST(InstanceTree, FindsForARunWhatBruteForceFindsForEachRay)
{
    Random random(2);
    int hits = 0;
    for (const int count : {2, 10, 63, 300}) {
        Objects objects;
        for (int i = 0; i < count; ++i)
            add_random(objects, random, 3);
        const InstanceTree tree = objects.tree();
        for (int i = 0; i < 300 / kThinning; ++i) {
            const std::vector<Ray> rays = run_of_rays(random, i % 3);
            std::vector<SceneHit> found(rays.size());
            const auto met = tree.closest_hits(rays, found), shadowed = tree.any_hits(rays);
            for (std::size_t k = 0; k < rays.size(); ++k) {
                const auto expected = tree.closest_hit_brute_force(rays[k]);
                ASSERT_EQ((met >> k & 1) != 0, expected.has_value());
                ASSERT_EQ((shadowed >> k & 1) != 0, expected.has_value());
                if (!expected) continue;
                ++hits;
                ASSERT_EQ(found[k].t, expected->t);
                ASSERT_EQ(found[k].instance, expected->instance);
                ASSERT_EQ(found[k].primitive, expected->primitive);
                ASSERT_EQ(found[k].point.position, expected->point.position);
                ASSERT_EQ(found[k].point.error, expected->point.error);
            }
        }
    }
    EXPECT_GT(hits, 3000 / kThinning);
}

TEST(InstanceTree, IsTheSameOnAnyNumberOfThreads)
{
    Random random(3);
    Objects objects;
    for (int i = 0; i < 6000; ++i)
        objects.add(Sphere{0.05}, random_placing(random, 3));
    const InstanceTree one = objects.tree();
    ThreadPool many(4);
    const InstanceTree other({one.instances().begin(), one.instances().end()}, BvhSplit::sah, many);
    EXPECT_EQ(one.bounds(), other.bounds());
    EXPECT_EQ(one.size_bytes(), other.size_bytes());
    for (int i = 0; i < 500; ++i) {
        const Ray ray{random.direction() * 5.0, random.direction()};
        const auto a = one.closest_hit(ray), b = other.closest_hit(ray);
        ASSERT_EQ(a.has_value(), b.has_value());
        if (a) {
            ASSERT_EQ(a->instance, b->instance);
        }
    }
}

TEST(InstanceTree, PrefersTheLowestInstanceAmongEquals)
{
    Objects objects;
    const Affine3 placed = Affine3::rotate_deg(30, {1, 2, 3});
    objects.add(Sphere{0.1}, Affine3::translate({9, 9, 9}));
    for (int i = 0; i < 7; ++i)
        objects.add(unit_box(), placed);
    const InstanceTree tree = objects.tree(), list = objects.list(true);
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d origin = random.direction() * 3.0;
        const Ray ray{origin, random.direction() * 0.3 - origin};
        for (const InstanceTree* asked : {&tree, &list}) {
            const auto hit = asked->closest_hit(ray);
            ASSERT_TRUE(hit);
            ASSERT_EQ(hit->instance, 1u);
        }
    }
}

TEST(InstanceTree, HidesObjectsFromTheCameraAlone)
{
    for (const int count : {1, 2}) {
        Objects objects;
        objects.add(unit_rectangle(), {}, false);
        if (count == 2) objects.add(unit_rectangle(), Affine3::translate({0, 0, -1}));
        const Ray ray{{0.1, 0.1, 1}, {0, 0, -1}};
        for (const InstanceTree& tree : {objects.tree(), objects.list(false), objects.list(true)}) {
            EXPECT_EQ(tree.closest_hit(ray, RayKind::other)->instance, 0u);
            const auto seen = tree.closest_hit(ray, RayKind::camera);
            EXPECT_EQ(seen.has_value(), count == 2);
            EXPECT_EQ(tree.any_hit(ray, RayKind::camera), count == 2);
            if (seen) {
                EXPECT_EQ(seen->instance, 1u);
            }
            EXPECT_TRUE(tree.any_hit(ray));
        }
    }
}

TEST(InstanceTree, TellsPointNormalAndWeightsInTheWorld)
{
    Random random(29);
    int hits = 0, mirrored = 0;
    for (int i = 0; i < 3000; ++i) {
        // Shears of up to 1e6, mirrored half the time.
        Affine3 placed = random_placing(random, 3);
        if (i % 3 == 0) {
            Affine3 shear;
            shear.rows[0].y = random.exponential(6);
            placed = Affine3::translate(placed.translation) * shear *
                     Affine3::scale({random.exponential(0.5), random.exponential(0.5), 1});
        }
        Objects objects;
        objects.add(unit_box(), placed);
        const InstanceTree tree = objects.tree();
        const Vec3d center = placed.translation;
        const Ray ray{center + random.direction() * 10.0, {}};
        const auto hit = tree.closest_hit({ray.origin, center - ray.origin});
        if (!hit) continue;
        ++hits;
        mirrored += placed.determinant() < 0;
        const SurfacePoint& p = hit->point;
        ASSERT_NEAR(length(p.normal), 1, 1e-12);
        // The box is convex and symmetric: outside is away from its centre.
        ASSERT_GT(dot(p.normal, p.position - center), 0) << i;
        const Mesh box = unit_box();
        const Triangle& t = box.triangles[hit->primitive];
        const Vec3d a = placed.point(to_double(box.positions[t[0]])),
                    b = placed.point(to_double(box.positions[t[1]])),
                    c = placed.point(to_double(box.positions[t[2]]));
        const double size = length(b - a) + length(c - a);
        ASSERT_LE(std::abs(dot(p.normal, normalize(b - a))), 1e-9);
        ASSERT_LE(std::abs(dot(p.normal, normalize(c - a))), 1e-9);
        const Vec3d w = hit->barycentrics;
        ASSERT_LE(length(a * w.x + b * w.y + c * w.z - p.position), 1e-9 * size);
        ASSERT_LE(length(placed.point(hit->object_position) - p.position), 1e-9 * size);
    }
    EXPECT_GT(hits, 2000);
    EXPECT_GT(mirrored, 500);
}

TEST(InstanceTree, OfNothingIsNeverHit)
{
    Objects none;
    const InstanceTree empty = none.tree();
    EXPECT_TRUE(empty.bounds().empty());
    EXPECT_FALSE(empty.any_hit(Ray{{0, 0, 1}, {0, 0, -1}}));
    EXPECT_FALSE(empty.closest_hit(Ray{{0, 0, 1}, {0, 0, -1}}));
}

TEST(InstanceTree, IsMissedByRaysThatAreNoRays)
{
    Objects objects;
    objects.add(unit_box(), {});
    objects.add(Sphere{1}, Affine3::translate({5, 0, 0}));
    const InstanceTree tree = objects.tree();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(tree.any_hit(Ray{{0, 0, 3}, {0, 0, -1}}));
    EXPECT_FALSE(tree.any_hit(Ray{{0, nan, 3}, {0, 0, -1}}));
    EXPECT_FALSE(tree.any_hit(Ray{{0, 0, 3}, {0, 0, nan}}));
    EXPECT_FALSE(tree.any_hit(Ray{{0, 0, 3}, {0, 0, 0}}));
    EXPECT_FALSE(tree.closest_hit(Ray{{0, 0, 3}, {0, 0, -1}, nan}));
}

} // namespace
