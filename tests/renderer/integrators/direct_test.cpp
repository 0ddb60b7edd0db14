// Pictures whose every pixel is known in closed form.
#include "renderer/integrators/direct.h"
#include "renderer/math/transcendental.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace renderer;
using tests::render_description;
using tests::TestScene;

namespace {

constexpr double kAlbedo = 0.6;

// A floor at y = 0 seen straight from above: the picture's point (x, y) is the floor's (x, -z) times
// `metres_a_pixel`.
struct FloorView {
    static constexpr std::uint32_t kSide = 32;
    static constexpr double kHeight = 10, kWidth = 8;

    static TestScene scene()
    {
        TestScene test;
        SceneDescription& d = test.description;
        d.camera.emplace();
        d.camera->position = {0, kHeight, 0};
        d.camera->aim = {0, 0, 0};
        d.camera->up = {0, 0, -1};
        d.camera->fov_deg = 2 * std::atan(kWidth / 2 / kHeight) * 180 / kPi;
        const float rho = static_cast<float>(kAlbedo);
        d.materials = {{"floor", DiffuseMaterial{{rho, rho, rho}}}};
        ObjectDescription& floor = d.objects.emplace_back();
        floor.shape = RectangleShape{100, 100};
        floor.material = 0;
        floor.world_from_object = Affine3::rotate_deg(-90, {1, 0, 0});
        d.environment = NoEnvironment{};
        d.transport.type = TransportType::direct;
        test.settings.image.width_px = test.settings.image.height_px = kSide;
        test.settings.quality.samples = 64;
        return test;
    }

    // Centre of a pixel on the floor.
    static Vec3d at(std::uint32_t x, std::uint32_t y)
    {
        const double step = kWidth / kSide;
        return {(x + 0.5) * step - kWidth / 2, 0, (y + 0.5) * step - kWidth / 2};
    }
};

double pixel(const LinearImage& image, std::uint32_t x, std::uint32_t y)
{
    return static_cast<double>(image.pixels[std::size_t{y} * image.width_px + x].g);
}

void add_occluder(TestScene& test, Shape shape, Vec3d at, bool visible = false)
{
    ObjectDescription& object = test.description.objects.emplace_back();
    object.shape = std::move(shape);
    object.world_from_object = Affine3::translate(at) * Affine3::rotate_deg(90, {1, 0, 0});
    object.visible_to_camera = visible;
}

} // namespace

TEST(DirectLight, OfAPointFallsAsCosineOverSquaredDistance)
{
    TestScene test = FloorView::scene();
    const Vec3d lamp{1, 3, -2};
    test.description.lights.emplace_back(PointLight{lamp, {50, 50, 50}});
    const LinearImage image = render_description(test).film.mean();
    for (std::uint32_t y = 0; y < FloorView::kSide; ++y)
        for (std::uint32_t x = 0; x < FloorView::kSide; ++x) {
            const Vec3d to_lamp = lamp - FloorView::at(x, y);
            const double d = length(to_lamp);
            const double want = kAlbedo / kPi * 50 * (to_lamp.y / d) / (d * d);
            // A pixel is a mean over its own square: second order in its width.
            ASSERT_NEAR(pixel(image, x, y), want, 0.004 * want) << x << " " << y;
        }
}

TEST(DirectLight, OfADirectionGivesAlbedoTimesIrradianceOverPi)
{
    TestScene test = FloorView::scene();
    test.description.lights.emplace_back(DirectionalLight{{3, -4, 0}, {2, 2, 2}});
    const LinearImage image = render_description(test).film.mean();
    for (const Rgb& p : image.pixels)
        ASSERT_NEAR(p.g, kAlbedo * 2 * 0.8 / kPi, 1e-6);
}

TEST(DirectLight, ComesThroughToBothSidesOfASurface)
{
    TestScene test = FloorView::scene();
    test.description.objects[0].world_from_object = Affine3::rotate_deg(90, {1, 0, 0}); // seen from its back
    test.description.lights.emplace_back(DirectionalLight{{0, -1, 0}, {1, 1, 1}});
    EXPECT_NEAR(pixel(render_description(test).film.mean(), 5, 5), kAlbedo / kPi, 1e-6);
    // But light from behind does not shine through.
    test.description.lights[0] = DirectionalLight{{0, 1, 0}, {1, 1, 1}};
    EXPECT_EQ(pixel(render_description(test).film.mean(), 5, 5), 0);
}

TEST(DirectLight, IsCutByASharpShadowInTheRightPlace)
{
    TestScene test = FloorView::scene();
    const Vec3d lamp{0, 4, 0};
    test.description.lights.emplace_back(PointLight{lamp, {50, 50, 50}});
    add_occluder(test, DiskShape{1}, {0, 2, 0}); // shadow: a disk of radius 2
    const LinearImage image = render_description(test).film.mean();
    const double half_pixel = FloorView::kWidth / FloorView::kSide * 0.7072;
    double lit_share = 0;
    for (std::uint32_t y = 0; y < FloorView::kSide; ++y)
        for (std::uint32_t x = 0; x < FloorView::kSide; ++x) {
            const Vec3d p = FloorView::at(x, y);
            const double radius = length(p), d = length(lamp - p);
            const double open = kAlbedo / kPi * 50 * 4 / (d * d * d);
            if (radius < 2 - half_pixel) {
                ASSERT_EQ(pixel(image, x, y), 0) << x << " " << y;
            } else if (radius > 2 + half_pixel) {
                ASSERT_NEAR(pixel(image, x, y), open, 0.01 * open) << x << " " << y;
            } else {
                lit_share += 1 - pixel(image, x, y) / open;
            }
        }
    EXPECT_GT(lit_share, 0); // the edge runs through pixels
}

TEST(ShadowRay, EndsAtTheLight)
{
    TestScene test = FloorView::scene();
    test.description.lights.emplace_back(PointLight{{0, 3, 0}, {10, 10, 10}});
    const LinearImage open = render_description(test).film.mean();
    add_occluder(test, RectangleShape{50, 50}, {0, 3.5, 0}); // beyond the light
    add_occluder(test, RectangleShape{50, 50}, {0, 3, 0});   // the light lies in it
    const LinearImage covered = render_description(test).film.mean();
    for (std::size_t i = 0; i < open.pixels.size(); ++i)
        ASSERT_EQ(open.pixels[i], covered.pixels[i]);
}

TEST(ShadowRay, TakesAwayOnlyItsOwnLight)
{
    TestScene test = FloorView::scene();
    PhongMaterial floor;
    floor.diffuse = {0.6f, 0.6f, 0.6f};
    floor.specular = {};
    floor.ambient = {0.125f, 0.125f, 0.125f};
    test.description.materials[0].material = floor;
    test.description.lights.emplace_back(PointLight{{0, 3, 0}, {10, 10, 10}});
    add_occluder(test, RectangleShape{90, 90}, {0, 2, 0});
    EXPECT_FLOAT_EQ(static_cast<float>(pixel(render_description(test).film.mean(), 3, 3)), 0.125f);
    test.description.lights.emplace_back(PointLight{{0, 1, 0}, {10, 10, 10}}); // below the occluder
    const Vec3d to_lamp = Vec3d{0, 1, 0} - FloorView::at(3, 3);
    const double d = length(to_lamp), want = 0.125 + kAlbedo / kPi * 10 / (d * d * d);
    EXPECT_NEAR(pixel(render_description(test).film.mean(), 3, 3), want, 0.02 * want);
}

TEST(ShadowRay, NeverHitsTheConvexSurfaceItLeaves)
{
    for (const double scale : {1e-3, 1.0, 1e4}) {
        TestScene test;
        SceneDescription& d = test.description;
        ObjectDescription& ball = d.objects.emplace_back();
        ball.shape = SphereShape{scale};
        ball.world_from_object = Affine3::translate({scale * 300, 0, -scale * 2});
        d.lights.emplace_back(DirectionalLight{{-0.35, -0.3, -1}, {static_cast<float>(kPi), 0, 0}});
        test.settings.image.width_px = test.settings.image.height_px = 48;
        test.settings.quality.samples = 4;
        const LinearImage image = render_description(test).film.mean();
        // The same picture as a furnace tells which pixels the ball fills: all of them are lit from where it
        // is seen.
        d.lights.clear();
        d.environment = ColorEnvironment{{1, 1, 1}};
        const LinearImage furnace = render_description(test).film.mean();
        int filled = 0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            if (furnace.pixels[i].r != 0.5f) continue;
            ++filled;
            ASSERT_GT(image.pixels[i].r, 0) << scale << " " << i;
            ASSERT_LE(image.pixels[i].r, 0.501f) << scale << " " << i;
        }
        EXPECT_GT(filled, 48 * 48 / 5) << scale;
        const auto middle = image.pixels[24 * 48 + 24];
        EXPECT_NEAR(middle.r, 0.5f, 0.02f) << scale;
    }
}

TEST(Environment, IsBackgroundAndFurnace)
{
    // A convex diffuse body under light that is the same from everywhere shows albedo times radiance: every
    // sample.
    TestScene test;
    SceneDescription& d = test.description;
    d.materials = {{"grey", DiffuseMaterial{{0.25f, 0.5f, 0.75f}}}};
    ObjectDescription& ball = d.objects.emplace_back();
    ball.shape = SphereShape{1};
    ball.material = 0;
    d.environment = ColorEnvironment{{2, 4, 8}};
    test.settings.image.width_px = test.settings.image.height_px = 32;
    test.settings.quality.samples = 1;
    const LinearImage image = render_description(test).film.mean();
    int on_ball = 0;
    for (const Rgb& p : image.pixels) {
        if (p == Rgb{2, 4, 8}) continue; // background
        ASSERT_EQ(p, (Rgb{0.5f, 2, 6}));
        ++on_ball;
    }
    EXPECT_GT(on_ball, 250);
    EXPECT_EQ(image.pixels[0], (Rgb{2, 4, 8}));
}

TEST(Environment, IsHalvedWhereHalfTheSkyIsCovered)
{
    // Form factor of an infinite-looking wall: at its foot a wall hides half of the light.
    TestScene test = FloorView::scene();
    test.description.environment = ColorEnvironment{{1, 1, 1}};
    ObjectDescription& wall = test.description.objects.emplace_back();
    wall.shape = RectangleShape{1e5, 1e5};
    wall.world_from_object = Affine3::translate({-4.0001, 0, 0}) * Affine3::rotate_deg(90, {0, 1, 0});
    test.settings.quality.samples = 1024;
    const LinearImage image = render_description(test).film.mean();
    double mean = 0;
    for (std::uint32_t y = 0; y < FloorView::kSide; ++y)
        mean += pixel(image, 0, y) / FloorView::kSide;
    EXPECT_NEAR(mean, kAlbedo / 2, 0.002);
}

TEST(Phong, IsFullEnergyInAFurnace)
{
    // Normalised Phong of albedo 1 at normal incidence: the centre of the sphere shows the environment.
    TestScene test;
    SceneDescription& d = test.description;
    PhongMaterial m;
    m.diffuse = {0.4f, 0.4f, 0.4f};
    m.specular = {0.6f, 0.6f, 0.6f};
    m.shininess = 10;
    d.materials = {{"phong", m}};
    ObjectDescription& ball = d.objects.emplace_back();
    ball.shape = SphereShape{1};
    ball.material = 0;
    d.environment = ColorEnvironment{{1, 1, 1}};
    d.camera.emplace();
    d.camera->position = {0, 0, 100};
    d.camera->aim = {0, 0, 0};
    d.camera->fov_deg = 0.01;
    test.settings.image.width_px = test.settings.image.height_px = 8;
    test.settings.quality.samples = 1024;
    double mean = 0;
    for (const Rgb& p : render_description(test).film.mean().pixels)
        mean += static_cast<double>(p.r) / 64;
    EXPECT_NEAR(mean, 1, 1e-3);
}

TEST(ShadingNormals, LetNoLightThroughAClosedSurface)
{
    // Eight segments: vertex normals disagree with the faces a lot. Lit from behind, seen from the front.
    TestScene test;
    test.meshes.push_back(tests::faceted_sphere(8, 6));
    SceneDescription& d = test.description;
    d.objects.emplace_back().shape = MeshShape{};
    d.camera.emplace();
    d.camera->position = {0, 0, 8};
    d.camera->aim = {0, 0, 0};
    d.camera->fov_deg = 20;
    d.lights.emplace_back(DirectionalLight{{0, 0, 1}, {1, 1, 1}}); // travels towards the camera
    test.settings.image.width_px = test.settings.image.height_px = 64;
    test.settings.quality.samples = 16;
    for (const Rgb& p : render_description(test).film.mean().pixels)
        ASSERT_EQ(p, Rgb{});
    // And from the front no sample is lost: nothing of the disc is black.
    d.lights[0] = DirectionalLight{{0, 0, -1}, {1, 1, 1}};
    const LinearImage front = render_description(test).film.mean();
    for (std::uint32_t y = 24; y < 40; ++y)
        for (std::uint32_t x = 24; x < 40; ++x)
            ASSERT_GT(pixel(front, x, y), 0.05);
}

TEST(Objects, HiddenFromTheCameraStillCastShadows)
{
    TestScene test = FloorView::scene();
    test.description.lights.emplace_back(DirectionalLight{{0, -1, 0}, {1, 1, 1}});
    add_occluder(test, RectangleShape{90, 90}, {0, 2, 0}, false);
    EXPECT_EQ(pixel(render_description(test).film.mean(), 4, 4), 0);
    test.description.objects[1].visible_to_camera = true;
    EXPECT_GT(pixel(render_description(test).film.mean(), 4, 4), 0);
}
