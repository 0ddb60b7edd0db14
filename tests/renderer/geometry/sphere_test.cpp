#include "renderer/geometry/sphere.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace renderer;
using random_scenes::Random;

// t of the near hit in a wider type, by the same geometry.
long double reference_t(const Ray& ray, long double radius)
{
    const long double ox = ray.origin.x, oy = ray.origin.y, oz = ray.origin.z;
    const long double dx = ray.direction.x, dy = ray.direction.y, dz = ray.direction.z;
    const long double dd = dx * dx + dy * dy + dz * dz, od = (ox * dx + oy * dy + oz * dz) / dd;
    const long double px = ox - od * dx, py = oy - od * dy, pz = oz - od * dz;
    return -od - std::sqrt((radius * radius - (px * px + py * py + pz * pz)) / dd);
}

TEST(Sphere, IsHitToFourUlpsFromAfar)
{
    Random random(27);
    for (const double distance : {2.0, 1e4, 1e5, 1e7})
        for (int i = 0; i < 5000; ++i) {
            Ray ray;
            ray.origin = random.direction() * distance;
            ray.direction = random.direction() * random.uniform(0, 0.5) - ray.origin;
            ray.direction = ray.direction * random.uniform(0.1, 3);
            const auto t = intersect(Sphere{1}, ray);
            ASSERT_TRUE(t);
            const long double expected = reference_t(ray, 1);
            ASSERT_LE(std::abs(static_cast<double>((*t - expected) / expected)),
                      4 * std::numeric_limits<double>::epsilon())
                << "from " << distance;
        }
}

TEST(Sphere, KeepsACircularOutlineFromAfar)
{
    // One part in 1e5 of the radius: a hundredth of a pixel where the sphere is 2000 pixels wide.
    for (const double distance : {1e4, 1e5, 1e7})
        for (int i = 0; i < 360; ++i) {
            const double turn = i * kPi / 180;
            const double sine = 1 / distance;
            for (const double factor : {1 - 1e-5, 1 + 1e-5}) {
                const double s = sine * factor, c = std::sqrt(1 - s * s);
                const Ray ray{{0, 0, distance}, {s * std::cos(turn), s * std::sin(turn), -c}};
                ASSERT_EQ(intersect(Sphere{1}, ray).has_value(), factor < 1) << distance << " at " << i;
            }
        }
}

TEST(Sphere, KeepsTheHorizonOfAPlanet)
{
    const double radius = 6.36e6, height = 1;
    double down = 1e-3, level = 0; // radians below level: hits the ground, misses it
    for (int i = 0; i < 80; ++i) {
        const double dip = (down + level) / 2;
        const Ray ray{{0, radius + height, 0}, {std::cos(dip), -std::sin(dip), 0}};
        (intersect(Sphere{radius}, ray) ? down : level) = dip;
    }
    EXPECT_NEAR(down, std::asin(std::sqrt(height * (2 * radius + height)) / (radius + height)), 1e-9);
    EXPECT_NEAR(down, 5.607721e-4, 1e-9);
}

TEST(Sphere, IsHitOnItsWayInAndOnItsWayOut)
{
    EXPECT_NEAR(*intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, -2}}), 1.5, 1e-15);
    EXPECT_NEAR(*intersect(Sphere{2}, Ray{{0, 0, 0}, {0, 3, 0}}), 2. / 3, 1e-15);
    EXPECT_NEAR(*intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, -1}, 3.5}), 7, 1e-15) << "range begins inside";
    EXPECT_FALSE(intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, 1}}));
    EXPECT_FALSE(intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, -1}, 0, 3}));
    EXPECT_FALSE(intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, -1}, 3.5, 6}));
    EXPECT_FALSE(intersect(Sphere{0}, Ray{{0, 0, 5}, {0, 0, -1}}));
    EXPECT_FALSE(intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, 0}}));
    EXPECT_TRUE(intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, -1e300}}));
    EXPECT_TRUE(intersect(Sphere{2}, Ray{{0, 0, 5}, {0, 0, -1e-300}}));
    const SurfacePoint p = point_at(Sphere{2}, Ray{{0, 0, 5}, {0, 0, -2}}, 1.5);
    EXPECT_EQ(p.position, (Vec3d{0, 0, 2}));
    EXPECT_EQ(p.normal, (Vec3d{0, 0, 1}));
}

} // namespace
