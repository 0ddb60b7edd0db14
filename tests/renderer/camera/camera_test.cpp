#include "renderer/camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using renderer::Camera;
using renderer::CameraDescription;
using renderer::Vec3d;

namespace {

CameraDescription looking(Vec3d from, Vec3d at)
{
    CameraDescription d;
    d.position = from;
    d.aim = at;
    return d;
}

double angle_between(Vec3d a, Vec3d b)
{
    return 2 * std::atan2(length(a - b), length(a + b));
}

// Solid angle of a triangle of unit directions. Source: A. van Oosterom, J. Strackee, 1983.
double solid_angle(Vec3d a, Vec3d b, Vec3d c)
{
    return 2 * std::atan2(std::abs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

} // namespace

TEST(Camera, LooksStraightForwardInTheCentreToTheBit)
{
    const Camera camera(looking({1, 2, 3}, {-7, 0.3, 11}), 101, 77);
    EXPECT_EQ(camera.direction(50.5, 38.5), camera.forward());
}

TEST(Camera, HasUpAboveAndRightToTheRight)
{
    const Camera camera(looking({0, 0, 5}, {0, 0, 0}), 100, 100);
    EXPECT_GT(camera.direction(50, 0).y, 0);
    EXPECT_LT(camera.direction(50, 100).y, 0);
    EXPECT_GT(camera.direction(100, 50).x, 0);
    EXPECT_LT(camera.direction(0, 50).x, 0);
}

TEST(Camera, PutsTheCornersAtTheFieldOfView)
{
    for (const double fov : {0.01, 45.0, 90.0, 179.9}) {
        CameraDescription d = looking({0, 0, 0}, {0, 0, -1});
        d.fov_deg = fov;
        const Camera camera(d, 320, 200);
        const long double tan_y =
            std::tan(static_cast<long double>(fov) / 360 * std::numbers::pi_v<long double>);
        const long double tan_x = tan_y * 320 / 200;
        const Vec3d want = normalize(Vec3d{static_cast<double>(tan_x), static_cast<double>(tan_y), -1});
        EXPECT_LE(angle_between(camera.direction(320, 0), want), 1e-12) << fov;
        const Vec3d other = normalize(Vec3d{-static_cast<double>(tan_x), -static_cast<double>(tan_y), -1});
        EXPECT_LE(angle_between(camera.direction(0, 200), other), 1e-12) << fov;
    }
}

TEST(Camera, ChoosesABasisWhereForwardIsParallelToUp)
{
    for (const double tilt : {0.0, 1e-12, -1e-12}) {
        CameraDescription d = looking({0, 10, 0}, {0, 0, tilt});
        const Camera down(d, 64, 64);
        EXPECT_NEAR(down.right().x, 1, 1e-9);
        EXPECT_NEAR(down.up().z, -1, 1e-9);
        d.aim = {0, 20, tilt};
        const Camera above(d, 64, 64);
        EXPECT_NEAR(above.right().x, 1, 1e-9);
        EXPECT_NEAR(above.up().z, 1, 1e-9);
    }
    CameraDescription sideways = looking({0, 0, 0}, {1, 0, 0});
    sideways.up = {-3, 0, 0};
    const Camera camera(sideways, 64, 64);
    EXPECT_NEAR(dot(cross(camera.right(), camera.up()), camera.forward()), -1, 1e-12);
}

TEST(Camera, HasAnOrthonormalBasisForSkewedAndHugeInput)
{
    for (const double scale : {1e-150, 1.0, 1e150}) {
        CameraDescription d;
        d.aim_is_direction = true;
        d.aim = Vec3d{3, -2, 7} * scale;
        d.up = Vec3d{1, 5, 2} * scale;
        const Camera c(d, 10, 10);
        EXPECT_NEAR(length(c.forward()), 1, 1e-15);
        EXPECT_NEAR(length(c.right()), 1, 1e-15);
        EXPECT_NEAR(length(c.up()), 1, 1e-15);
        EXPECT_NEAR(dot(c.forward(), c.up()), 0, 1e-15);
        EXPECT_NEAR(dot(c.right(), c.up()), 0, 1e-15);
    }
}

TEST(Camera, DividesTheFrustumAmongItsPixelsFromFarAway)
{
    // The eye 1e8 m from what it looks at.
    const Camera camera(looking({1e8, 3, -5}, {0, 0, 0}), 64, 48);
    double sum = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const Vec3d a = camera.direction(x, y), b = camera.direction(x + 1, y),
                        c = camera.direction(x + 1, y + 1), d = camera.direction(x, y + 1);
            sum += solid_angle(a, b, c) + solid_angle(a, c, d);
        }
    const double whole =
        solid_angle(camera.direction(0, 0), camera.direction(64, 0), camera.direction(64, 48)) +
        solid_angle(camera.direction(0, 0), camera.direction(64, 48), camera.direction(0, 48));
    EXPECT_NEAR(sum, whole, 1e-6 * whole);
}

TEST(Camera, WithALensSeesWhatIsInFocusThroughAllOfIt)
{
    CameraDescription d = looking({1, 2, 3}, {1, 2, -1});
    d.lens_radius_m = 0.5;
    d.focus_distance_m = 4;
    const Camera camera(d, 100, 80);
    ASSERT_TRUE(camera.needs_lens());
    // The plane of focus is z = -1: every ray of one point of the picture meets it in one point.
    const auto at_focus = [&](double x, double y, renderer::Sample2 lens) {
        const renderer::Ray ray = camera.ray(x, y, lens);
        EXPECT_NEAR(length(ray.direction), 1, 1e-12);
        EXPECT_LE(length(ray.origin - d.position), 0.5 + 1e-12);
        return ray.at((-1 - ray.origin.z) / ray.direction.z);
    };
    for (const double x : {0.0, 50.0, 99.0}) {
        const Vec3d want = at_focus(x, 20, {0.5f, 0.5f});
        for (const renderer::Sample2 lens : {renderer::Sample2{0, 0}, {0.9f, 0.1f}, {0.3f, 0.99f}})
            EXPECT_NEAR(length(at_focus(x, 20, lens) - want), 0, 1e-12);
    }
    // Left out, it is sharp where it looks.
    d.focus_distance_m.reset();
    const renderer::Ray ray = Camera(d, 100, 80).ray(50, 40, {0.1f, 0.2f});
    EXPECT_NEAR(length(ray.at((-1 - ray.origin.z) / ray.direction.z) - Vec3d{1, 2, -1}), 0, 1e-12);
}

TEST(Camera, OfParallelRaysShowsItsHeightEverywhere)
{
    CameraDescription d = looking({0, 0, 5}, {0, 0, 0});
    d.projection = renderer::Projection::orthographic;
    d.height_m = 3;
    const Camera camera(d, 200, 100);
    EXPECT_EQ(camera.ray(0, 0, {}).direction, (Vec3d{0, 0, -1}));
    EXPECT_NEAR(length(camera.ray(0, 0, {}).origin - Vec3d{-3, 1.5, 5}), 0, 1e-12);
    EXPECT_NEAR(length(camera.ray(200, 100, {}).origin - Vec3d{3, -1.5, 5}), 0, 1e-12);
}

TEST(Camera, AllAroundLooksAlongItsViewInTheCentreAndRightToTheRight)
{
    CameraDescription d;
    d.projection = renderer::Projection::panorama;
    const Camera camera(d, 400, 200);
    EXPECT_NEAR(length(camera.ray(200, 100, {}).direction - Vec3d{0, 0, -1}), 0, 1e-15);
    EXPECT_NEAR(length(camera.ray(300, 100, {}).direction - Vec3d{1, 0, 0}), 0, 1e-15);
    EXPECT_NEAR(length(camera.ray(0, 100, {}).direction - Vec3d{0, 0, 1}), 0, 1e-15);
    EXPECT_NEAR(length(camera.ray(77, 0, {}).direction - Vec3d{0, 1, 0}), 0, 1e-15);
}
