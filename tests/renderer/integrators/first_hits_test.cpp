// What camera rays hit first, against closed forms, by every integrator.
#include "renderer/integrators/direct.h"
#include "renderer/integrators/first_hits.h"
#include "renderer/integrators/path.h"
#include "renderer/integrators/probes.h"
#include "renderer/integrators/whitted.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

using namespace renderer;
using tests::make_ready;
using tests::TestScene;

namespace {

constexpr double kRadius = 2, kDistance = 10;

// A ball in the origin, seen from the z axis.
TestScene ball(const Material& material)
{
    TestScene test;
    SceneDescription& d = test.description;
    d.materials = {{"it", material}};
    ObjectDescription& object = d.objects.emplace_back();
    object.shape = SphereShape{kRadius};
    object.material = 0;
    CameraDescription camera;
    camera.position = {0, 0, kDistance};
    camera.aim = {0, 0, 0};
    d.camera = camera;
    d.environment = ColorEnvironment{{1, 1, 1}};
    d.lights.emplace_back(PointLight{{3, 4, 9}, {30, 30, 30}});
    return test;
}

ObjectDescription& add_wall(TestScene& test, double z)
{
    ObjectDescription& wall = test.description.objects.emplace_back();
    wall.shape = RectangleShape{100, 100};
    wall.world_from_object = Affine3::translate({0, 0, z});
    return wall;
}

struct Way {
    std::string name;
    std::function<void(const Scene&, std::span<const CameraSample>, std::span<Rgb>, FirstHits)> radiance;
};

std::vector<Way> every_integrator()
{
    static RayTally tally;
    const auto of = [](auto radiance, auto... more) {
        return [=](const Scene& scene,
                   std::span<const CameraSample> samples,
                   std::span<Rgb> found,
                   FirstHits first) {
            radiance(scene, more..., samples, found, tally, std::stop_token(), first);
        };
    };
    return {{"direct", of(direct_radiance)},
            {"whitted", of(whitted_radiance, 4u)},
            {"path", of(path_radiance, PathLimits{.max_depth = 4})},
            {"ambient occlusion", of(occlusion_radiance)},
            {"normals", of(normals_radiance)}};
}

// Of rays through the middles of a grid of pixels of the camera's picture.
struct Look {
    std::vector<Ray> rays;
    std::vector<FirstHit> first;
};

Look look(const TestScene& test, const Way& way)
{
    constexpr std::uint32_t kSide = 6;
    TestScene small = test;
    small.settings.image.width_px = small.settings.image.height_px = kSide;
    ThreadPool pool(1);
    const auto ready = make_ready(small, pool);
    const PixelSampler sampler(1, 0, 0);
    std::vector<CameraSample> samples;
    Look out;
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            out.rays.push_back(ready.scene->camera().ray(x + 0.5, y + 0.5, {}));
            samples.push_back({out.rays.back(), &sampler, 0});
        }
    std::vector<Rgb> found(samples.size());
    out.first.resize(samples.size());
    way.radiance(*ready.scene, samples, found, out.first);
    return out;
}

// Where a ray from without meets a ball in the origin; below 0: nowhere.
double distance_to_ball(const Ray& ray)
{
    const double b = dot(ray.origin, ray.direction);
    const double below = b * b - (dot(ray.origin, ray.origin) - kRadius * kRadius);
    return below < 0 ? -1 : -b - std::sqrt(below);
}

void expect_near(Vec3f found, Vec3d want)
{
    EXPECT_NEAR(found.x, want.x, 1e-6);
    EXPECT_NEAR(found.y, want.y, 1e-6);
    EXPECT_NEAR(found.z, want.z, 1e-6);
}

} // namespace

TEST(FirstHits, AreThoseOfABallByClosedForm)
{
    const Rgb color{0.7f, 0.5f, 0.3f};
    for (const Way& way : every_integrator()) {
        SCOPED_TRACE(way.name);
        const Look seen = look(ball(DiffuseMaterial{color}), way);
        std::size_t met = 0;
        for (std::size_t i = 0; i < seen.rays.size(); ++i) {
            const Ray& ray = seen.rays[i];
            const double want = distance_to_ball(ray);
            ASSERT_EQ(seen.first[i].is_there, want >= 0) << i;
            if (want < 0) continue;
            ++met;
            EXPECT_NEAR(seen.first[i].distance_m, want, 1e-9);
            expect_near(seen.first[i].normal, (ray.origin + ray.direction * want) / kRadius);
            EXPECT_EQ(seen.first[i].albedo, color);
        }
        EXPECT_GT(met, 3u);
        EXPECT_LT(met, seen.rays.size());
    }
}

TEST(FirstHits, SeeGlassAndMirrorsThemselves)
{
    for (const Way& way : every_integrator())
        for (const auto& [material, albedo] :
             {std::pair<Material, Rgb>{GlassMaterial{}, {1, 1, 1}},
              std::pair<Material, Rgb>{MirrorMaterial{{0.9f, 0.8f, 0.7f}}, {0.9f, 0.8f, 0.7f}}}) {
            SCOPED_TRACE(way.name);
            if (way.name == "direct") continue; // not for such scenes
            TestScene test = ball(material);
            add_wall(test, -5);
            const Look seen = look(test, way);
            for (std::size_t i = 0; i < seen.rays.size(); ++i) {
                const double want = distance_to_ball(seen.rays[i]);
                ASSERT_TRUE(seen.first[i].is_there);
                if (want < 0) continue;
                EXPECT_NEAR(seen.first[i].distance_m, want, 1e-9);
                EXPECT_EQ(seen.first[i].albedo, albedo);
            }
        }
}

TEST(FirstHits, FaceTheCameraAlsoFromWithin)
{
    TestScene test = ball(DiffuseMaterial{});
    test.description.camera->position = {};
    test.description.camera->aim = {1, 2, 3};
    for (const Way& way : every_integrator()) {
        const Look seen = look(test, way);
        for (std::size_t i = 0; i < seen.rays.size(); ++i) {
            EXPECT_NEAR(seen.first[i].distance_m, kRadius, 1e-9);
            expect_near(seen.first[i].normal, -seen.rays[i].direction);
        }
    }
}

TEST(FirstHits, OfLightsAreBlackAndOfWhatTheCameraDoesNotSeeAreNot)
{
    TestScene test = ball(EmitterMaterial{.radiance = {3, 3, 3}});
    add_wall(test, -5);
    ObjectDescription& unseen = add_wall(test, 5);
    unseen.visible_to_camera = false;
    const Look seen = look(test, every_integrator()[2]);
    for (std::size_t i = 0; i < seen.rays.size(); ++i) {
        const double want = distance_to_ball(seen.rays[i]);
        EXPECT_EQ(seen.first[i].albedo, want < 0 ? DiffuseMaterial{}.color.value : Rgb{});
        EXPECT_NEAR(
            seen.first[i].distance_m, want < 0 ? (-5 - kDistance) / seen.rays[i].direction.z : want, 1e-9);
    }
}

TEST(FirstHits, HaveTheAlbedoThatAPictureGives)
{
    // Four texels, as large as a quarter of the picture each.
    const std::array<Rgb, 4> texels{Rgb{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.25f, 0.5f, 0.75f}};
    Image image{2, 2, 3, PixelType::real_32, {}};
    image.bytes.append(std::as_bytes(std::span(texels)));
    DiffuseMaterial material;
    material.color.texture = TextureUse{};
    material.color.texture->filter = TextureFilter::nearest;
    TestScene test;
    test.description.materials = {{"picture", material}};
    test.description.images = {{"picture.png", "", ""}};
    test.images = {std::make_shared<const Image>(std::move(image))};
    ObjectDescription& object = test.description.objects.emplace_back();
    object.shape = RectangleShape{2, 2};
    object.material = 0;
    CameraDescription camera;
    camera.projection = Projection::orthographic;
    camera.position = {0, 0, 3};
    camera.height_m = 2;
    test.description.camera = camera;
    test.description.environment = ColorEnvironment{{1, 1, 1}};
    for (const Way& way : every_integrator()) {
        const Look seen = look(test, way);
        for (std::size_t i = 0; i < seen.rays.size(); ++i) {
            const std::size_t column = seen.rays[i].origin.x > 0 ? 1 : 0,
                              row = seen.rays[i].origin.y > 0 ? 0 : 1;
            EXPECT_EQ(seen.first[i].albedo, texels[2 * row + column]) << way.name;
            EXPECT_NEAR(seen.first[i].distance_m, 3, 1e-12);
        }
    }
}
