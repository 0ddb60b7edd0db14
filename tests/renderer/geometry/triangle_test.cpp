#include "renderer/geometry/triangle.h"
#include "tests/renderer/accel/random_scenes.h"
#include "tests/support/thinning.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace {

using namespace renderer;
using random_scenes::closed_sphere;
using random_scenes::Random;

using tests::kThinning;

template <typename T>
Vec3<T> as(Vec3d v)
{
    return {static_cast<T>(v.x), static_cast<T>(v.y), static_cast<T>(v.z)};
}

template <typename T>
BasicRay<T> ray_to(Vec3d origin, Vec3d target)
{
    return {as<T>(origin), as<T>(target) - as<T>(origin)};
}

template <typename T>
class TriangleTest : public ::testing::Test {
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(TriangleTest, Precisions);

// A diagonal that Moller-Trumbore in float was seen to let a ray slip through.
TYPED_TEST(TriangleTest, HoldsAtTheDiagonalOfAQuad)
{
    using V = Vec3<TypeParam>;
    const V a{-5, -5, 0}, b{5, -5, 0}, c{5, 5, 0}, d{-5, 5, 0};
    const BasicRay<TypeParam> ray{V{0, 0, 10}, as<TypeParam>({.30458447, .30458447, -.9024725})};
    const auto first = intersect_watertight(ray, a, b, c), second = intersect_watertight(ray, a, c, d);
    ASSERT_TRUE(first || second);
    const V p = ray.at(first ? first->t : second->t);
    const double tolerance = std::is_same_v<TypeParam, float> ? 2e-6 : 1e-7; // the direction has 8 digits
    EXPECT_NEAR(static_cast<double>(p.x), 3.375, tolerance);
    EXPECT_NEAR(static_cast<double>(p.y), 3.375, tolerance);
    EXPECT_NEAR(static_cast<double>(p.z), 0, tolerance);
}

TYPED_TEST(TriangleTest, LetsNoRayOutOfAClosedMesh)
{
    Random random(7);
    const Mesh mesh = closed_sphere(random, {0, 0, 0}, 1, 6, 16, 16);
    const auto corner = [&](const Triangle& t, std::size_t k) { return to_double(mesh.positions[t[k]]); };
    for (int i = 0; i < 30000 / kThinning; ++i) {
        const Triangle& aim = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        const Vec3d origin = random.direction() * 0.2;
        const double w = random.uniform();
        const Vec3d target = i % 3 == 0   ? origin + random.direction()
                             : i % 3 == 1 ? corner(aim, 0)
                                          : corner(aim, 0) * w + corner(aim, 1) * (1 - w);
        const auto ray = ray_to<TypeParam>(origin, target);
        bool hit = false;
        for (const Triangle& t : mesh.triangles)
            hit = hit || intersect_watertight(ray,
                                              as<TypeParam>(corner(t, 0)),
                                              as<TypeParam>(corner(t, 1)),
                                              as<TypeParam>(corner(t, 2)));
        ASSERT_TRUE(hit) << "ray " << i;
    }
}

TYPED_TEST(TriangleTest, HoldsWhereSixMeet)
{
    using V = Vec3<TypeParam>;
    Random random(12);
    for (int i = 0; i < 2000; ++i) {
        const Vec3d hub = random.direction() * random.uniform(0, 3);
        std::array<V, 6> rim;
        for (std::size_t k = 0; k < 6; ++k)
            rim[k] = as<TypeParam>(hub + Vec3d{std::cos(static_cast<double>(k) * kPi / 3),
                                               std::sin(static_cast<double>(k) * kPi / 3),
                                               random.uniform(-.3, .3)});
        const V center = as<TypeParam>(hub);
        BasicRay<TypeParam> ray{as<TypeParam>(hub + Vec3d{random.uniform(-1, 1), random.uniform(-1, 1), 4}),
                                {}};
        ray.direction = center - ray.origin;
        int hits = 0;
        for (std::size_t k = 0; k < 6; ++k)
            hits += intersect_watertight(ray, center, rim[k], rim[(k + 1) % 6]).has_value();
        ASSERT_GE(hits, 1);
        // Counting crossings: on from the last hit, what lies within its rounding is the same crossing.
        int crossings = 0;
        for (;;) {
            std::optional<TriangleHit<TypeParam>> next;
            for (std::size_t k = 0; k < 6; ++k) {
                const auto hit = intersect_watertight(ray, center, rim[k], rim[(k + 1) % 6]);
                if (hit && (!next || hit->t < next->t)) next = hit;
            }
            if (!next) break;
            ASSERT_LT(++crossings, 7);
            ray.t_min = next->t;
        }
        ASSERT_EQ(crossings, 1) << i;
    }
}

TYPED_TEST(TriangleTest, IsMissedWithinItsPlane)
{
    using V = Vec3<TypeParam>;
    const V a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    for (const V direction : {V{1, 0, 0}, V{1, TypeParam(-0.0), TypeParam(-0.0)}, V{2, TypeParam(0.1), 0}}) {
        const BasicRay<TypeParam> ray{V{-1, TypeParam(.5), 0}, direction};
        EXPECT_FALSE(intersect_watertight(ray, a, b, c));
        EXPECT_FALSE(intersect_moller_trumbore(ray, a, b, c));
    }
}

TYPED_TEST(TriangleTest, WithoutAreaIsNeverHit)
{
    Random random(13);
    for (int i = 0; i < 20000; ++i) {
        // Small integers: exactly on a line.
        const auto step = [&] { return static_cast<double>(random.below(9)) - 4; };
        const Vec3d p{step(), step(), step()}, along{step(), step(), step()};
        const std::array<Vec3<TypeParam>, 3> v{
            as<TypeParam>(p), as<TypeParam>(p + along * step()), as<TypeParam>(p + along * step())};
        const auto ray = ray_to<TypeParam>(Vec3d{step(), step(), 10}, p + along * random.uniform(-4, 4));
        ASSERT_FALSE(intersect_watertight(ray, v[0], v[1], v[2])) << i;
    }
}

TYPED_TEST(TriangleTest, GivesWeightsThatMakeThePoint)
{
    Random random(14);
    const double eps = static_cast<double>(std::numeric_limits<TypeParam>::epsilon());
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3<TypeParam> a = as<TypeParam>(random.direction()), b = as<TypeParam>(random.direction()),
                              c = as<TypeParam>(random.direction());
        const auto ray = ray_to<TypeParam>(random.direction() * 5.0, random.direction() * 0.5);
        const auto hit = intersect_watertight(ray, a, b, c);
        const auto other = intersect_moller_trumbore(ray, a, b, c);
        if (!hit) continue;
        ++hits;
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_GE(hit->barycentrics[k], 0);
            ASSERT_LE(hit->barycentrics[k], 1 + TypeParam(2) * static_cast<TypeParam>(eps));
        }
        const Vec3<TypeParam> n = cross(b - a, c - a);
        const double grazing = static_cast<double>(std::abs(dot(n, ray.direction)) / length(ray.direction));
        const Vec3<TypeParam> p = a * hit->barycentrics.x + b * hit->barycentrics.y + c * hit->barycentrics.z;
        ASSERT_LE(static_cast<double>(length(p - ray.at(hit->t))), 200 * eps / grazing);
        if (other) {
            ASSERT_NEAR(static_cast<double>(hit->t), static_cast<double>(other->t), 200 * eps / grazing);
        }
    }
    EXPECT_GT(hits, 1000);
}

// No hit lies beyond the farthest corner, however thin the triangle and however flat the ray.
TEST(Triangle, ThatIsThinIsHitWhereItIs)
{
    Random random(15);
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3d a = random.direction() * 0.5, along = random.direction();
        const Vec3d b = a + along,
                    c = a + along * random.uniform() + random.direction() * 1e-12; // a needle 1e-12 : 1
        Ray ray;
        ray.origin = a + random.direction() * 3.0;
        ray.direction = a * 0.25 + b * 0.5 + c * 0.25 - ray.origin;
        if (i % 2 == 0) ray.origin = a - along + random.direction() * 0.005; // half a degree from its length
        if (i % 2 == 0) ray.direction = b - ray.origin;
        const auto hit = intersect_watertight(ray, a, b, c);
        if (!hit) continue;
        ++hits;
        const double farthest =
            std::max({length(a - ray.origin), length(b - ray.origin), length(c - ray.origin)});
        ASSERT_LE(hit->t * length(ray.direction), farthest * (1 + 1e-12));
        const Vec3d p = a * hit->barycentrics.x + b * hit->barycentrics.y + c * hit->barycentrics.z;
        // Off the ray by no more than 1e-9 of the needle's size.
        const Vec3d off = cross(p - ray.origin, normalize(ray.direction));
        ASSERT_LE(length(off), 1e-9) << i;
    }
    EXPECT_GT(hits, 1000);
}

// Seen from afar its corners differ in their last bits only: edge values that round to 0 must not make a hit.
TEST(Triangle, ThatIsSmallIsNotHitFromFarBesideIt)
{
    Random random(16);
    for (int i = 0; i < 200000 / kThinning; ++i) {
        const double away = std::pow(10, random.uniform(6, 13));
        const Vec3d a = random.direction() * 1e-3, b = random.direction() * 1e-3,
                    c = random.direction() * 1e-3;
        Ray ray;
        ray.origin = random.direction() * away;
        ray.direction = random.direction() * away - ray.origin;
        const auto hit = intersect_watertight(ray, a, b, c);
        if (!hit) continue;
        ASSERT_LT(length(ray.at(hit->t)), 1e-2 + 1e-14 * away) << i;
    }
}

TEST(Triangle, KeepsItsRange)
{
    const Vec3d a{-1, -1, 0}, b{1, -1, 0}, c{0, 1, 0};
    const auto hits = [&](const Ray& ray) { return intersect_watertight(ray, a, b, c).has_value(); };
    EXPECT_TRUE(hits({{0, 0, 2}, {0, 0, -1}}));
    EXPECT_TRUE(hits({{0, 0, -2}, {0, 0, 1}})) << "from behind";
    EXPECT_FALSE(hits({{0, 0, 2}, {0, 0, 1}})) << "it is behind the origin";
    EXPECT_FALSE(hits({{0, 0, 2}, {0, 0, -1}, 0, 2})) << "the range is open at its end";
    EXPECT_FALSE(hits({{0, 0, 2}, {0, 0, -1}, 2, 3})) << "and at its start";
    EXPECT_FALSE(hits({{0, 0, 0}, {0, 0, -1}})) << "a ray that starts on it";
    EXPECT_FALSE(hits({{0, 0, 2}, {0, 0, 0}}));
    EXPECT_FALSE(hits({{0, 0, std::numeric_limits<double>::quiet_NaN()}, {0, 0, -1}}));
    const Ray ray{{0, 0, 2}, {0, 0, -1}, 0, 1.5};
    EXPECT_FALSE(intersect_moller_trumbore(ray, a, b, c));
    EXPECT_TRUE(intersect_moller_trumbore(Ray{{0, 0, 2}, {0, 0, -1}}, a, b, c));
}

} // namespace
