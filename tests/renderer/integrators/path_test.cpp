// Light that is scattered many times, against closed forms.
#include "renderer/integrators/path.h"
#include "renderer/math/transcendental.h"
#include "tests/support/picture_error.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

using namespace renderer;
using tests::render_description;
using tests::TestScene;

namespace {

DiffuseMaterial diffuse(float albedo)
{
    DiffuseMaterial m;
    m.color.value = {albedo, albedo, albedo};
    return m;
}

// A meter inside a sphere of radius 1 that is made of `material`.
TestScene inside_a_sphere(Material material)
{
    TestScene test;
    SceneDescription& d = test.description;
    d.materials = {{"wall", std::move(material)}};
    ObjectDescription& wall = d.objects.emplace_back();
    wall.shape = SphereShape{1};
    wall.material = 0;
    d.environment = NoEnvironment{};
    d.transport.type = TransportType::path;
    d.camera.emplace();
    d.camera->projection = Projection::meter;
    d.camera->position = {0.2, -0.1, 0.3};
    d.camera->aim = {0.9, 0.4, -0.2};
    test.settings.image.width_px = test.settings.image.height_px = 4;
    test.settings.quality.samples = 2048;
    return test;
}

MeterReading read(const TestScene& test)
{
    return render_description(test).report.meter.value();
}

void expect_reading(const TestScene& test, double want, double most_error = 1e-2)
{
    const MeterReading got = read(test);
    const auto error = static_cast<double>(got.standard_error.g);
    EXPECT_NEAR(static_cast<double>(got.value.g), want, std::max(4 * error, 1e-5 * want));
    EXPECT_LT(error, most_error * want);
}

// A surface that scatters `albedo` and, as ambient, gives `radiance` of its own.
PhongMaterial glowing(float albedo, float radiance)
{
    PhongMaterial m;
    m.diffuse.value = {albedo, albedo, albedo};
    m.specular.value = {};
    m.ambient = {radiance, radiance, radiance};
    return m;
}

} // namespace

TEST(Path, OfAPointLightInASphereFindsTheWholeSeries)
{
    // Kd 1/2 and I = pi: E = pi everywhere, L = 1/2 (1 + 1/2 + 1/4 ...) = 1.
    TestScene test = inside_a_sphere(diffuse(0.5f));
    const float i = static_cast<float>(kPi);
    test.description.lights.emplace_back(PointLight{{0, 0, 0}, {i, i, i}});
    expect_reading(test, 1, 1e-3);
}

TEST(Path, InAnEnclosureIsTheGeometricSeriesCutAtEveryDepth)
{
    for (const float albedo : {0.5f, 0.8f})
        for (const std::uint32_t depth : {0u, 1u, 2u, 5u, 1000000u}) {
            TestScene test = inside_a_sphere(glowing(albedo, 2));
            test.description.transport.max_depth = depth;
            const double rho = static_cast<double>(albedo);
            expect_reading(test, 2 * (1 - std::pow(rho, depth + 1.0)) / (1 - rho));
        }
}

TEST(Path, OfNoLossIsAsLongAsItsDepth)
{
    TestScene test = inside_a_sphere(glowing(1, 1));
    test.settings.quality.samples = 1;
    test.description.transport.max_depth = 1000;
    expect_reading(test, 1001, 1e-5);
}

TEST(Path, IsTheSameInAnyRunAndOnAnyThreads)
{
    TestScene test = tests::kitchen_sink();
    test.description.transport.type = TransportType::path;
    test.settings.quality.samples = 4;
    const std::uint64_t want = tests::digest(render_description(test, 1).film);
    for (const std::uint32_t tile : {1u, 7u, 64u}) {
        test.settings.acceleration.tile_px = tile;
        EXPECT_EQ(tests::digest(render_description(test, 3).film), want) << tile;
    }
}

TEST(Path, ScalesWithTheBrightnessOfItsLights)
{
    const auto room = [](float radiance) {
        TestScene test = inside_a_sphere(diffuse(0.5f));
        RectangleLight lamp;
        lamp.width_m = lamp.height_m = 0.4;
        lamp.radiance = {radiance, radiance, radiance};
        lamp.two_sided = true;
        test.description.lights.emplace_back(lamp);
        test.settings.quality.samples = 16;
        return read(test).value.g;
    };
    const float one = room(1);
    EXPECT_GT(one, 0);
    for (const int power : {-99, 99})
        EXPECT_EQ(room(std::ldexp(1.0f, power)), std::ldexp(one, power)) << power;
    for (const float scale : {1e-30f, 1e30f})
        EXPECT_NEAR(room(scale) / scale, one, 1e-5f * one) << scale;
}

TEST(Path, OfUniformSkyGivesPiTimesItsRadianceAsIrradiance)
{
    TestScene test;
    test.description.environment = ColorEnvironment{{2, 2, 2}};
    test.description.camera.emplace();
    test.description.camera->projection = Projection::meter;
    test.description.camera->quantity = MeterQuantity::irradiance;
    test.settings.image.width_px = test.settings.image.height_px = 4;
    test.settings.quality.samples = 16;
    expect_reading(test, 2 * kPi, 1e-6);
}

TEST(Path, MeasuresARectangleOfLight)
{
    // E / (pi L) under its centre: see emitter_test.cpp. The meter's own rays find it: no light is sampled.
    TestScene test;
    RectangleLight lamp;
    lamp.width_m = lamp.height_m = 2;
    lamp.radiance = {1, 1, 1};
    lamp.world_from_light = Affine3::translate({0, 1, 0}) * Affine3::rotate_deg(90, {1, 0, 0});
    test.description.lights.emplace_back(lamp);
    test.description.environment = NoEnvironment{};
    test.description.camera.emplace();
    test.description.camera->projection = Projection::meter;
    test.description.camera->quantity = MeterQuantity::irradiance;
    test.description.camera->aim_is_direction = true;
    test.description.camera->aim = {0, 1, 0};
    test.settings.image.width_px = test.settings.image.height_px = 4;
    test.settings.quality.samples = 4096;
    expect_reading(test, 0.5541264240 * kPi, 1e-3);
}

namespace {

// A knot of which every third triangle shines.
Mesh own_lamp(Rgb reflected)
{
    Mesh mesh = tests::knot(24, 6);
    mesh.materials.resize(2);
    mesh.materials[0].diffuse = mesh.materials[1].diffuse = reflected;
    mesh.materials[1].emission = {9, 8, 7};
    std::vector<std::uint16_t> materials(mesh.triangles.size());
    for (std::size_t i = 0; i < materials.size(); i += 3)
        materials[i] = 1;
    mesh.triangle_materials.append(std::span<const std::uint16_t>(materials));
    return mesh;
}

// Scenes where lights and the material's own rays can both find what shines.
std::vector<TestScene> scenes_with_extended_lights()
{
    std::vector<TestScene> scenes;
    const auto start = [] {
        TestScene test;
        SceneDescription& d = test.description;
        PhongMaterial glossy;
        glossy.diffuse.value = {0.3f, 0.4f, 0.2f};
        glossy.specular.value = {0.5f, 0.4f, 0.5f};
        glossy.shininess = 60;
        d.materials = {{"floor", diffuse(0.7f)}, {"glossy", glossy}};
        ObjectDescription& floor = d.objects.emplace_back();
        floor.shape = RectangleShape{20, 20};
        floor.material = 0;
        floor.world_from_object = Affine3::rotate_deg(-90, {1, 0, 0});
        ObjectDescription& ball = d.objects.emplace_back();
        ball.shape = SphereShape{0.5};
        ball.material = 1;
        ball.world_from_object = Affine3::translate({0, 0.5, 0});
        d.camera.emplace();
        d.camera->position = {0, 1.5, 4};
        d.camera->aim = {0, 0.4, 0};
        d.environment = NoEnvironment{};
        d.transport.max_depth = 3;
        test.settings.image.width_px = test.settings.image.height_px = 16;
        return test;
    };
    const Affine3 down = Affine3::rotate_deg(90, {1, 0, 0});
    {
        TestScene test = start();
        RectangleLight lamp;
        lamp.width_m = 2;
        lamp.world_from_light = Affine3::translate({1, 2, 0.5}) * down;
        lamp.radiance = {5, 4, 3};
        test.description.lights.emplace_back(lamp);
        scenes.push_back(test);
        // Sheared: sampled by its area.
        lamp.world_from_light.rows[0].y = 0.5;
        test.description.lights[0] = lamp;
        scenes.push_back(test);
    }
    {
        TestScene test = start();
        DiskLight lamp;
        lamp.radius_m = 0.8;
        lamp.world_from_light = Affine3::translate({-1, 1.5, 1}) * down;
        lamp.radiance = {4, 4, 4};
        test.description.lights.emplace_back(lamp);
        scenes.push_back(test);
    }
    {
        TestScene test = start();
        SphereLight lamp;
        lamp.radius_m = 0.4;
        lamp.world_from_light = Affine3::translate({1, 1.2, 1});
        lamp.radiance = {6, 5, 4};
        test.description.lights.emplace_back(lamp);
        scenes.push_back(test);
    }
    {
        TestScene test = start();
        SunLight sun;
        sun.direction = {-1, -1, -0.5};
        sun.angular_radius_deg = 10;
        test.description.lights.emplace_back(sun);
        scenes.push_back(test);
    }
    {
        // An emissive mesh: a knot of many triangles, picked by the tree.
        TestScene test = start();
        test.meshes.push_back(tests::knot(24, 6));
        ObjectDescription& knot = test.description.objects.emplace_back();
        knot.shape = MeshShape{};
        EmitterMaterial shine;
        shine.radiance.value = {3, 3, 3};
        test.description.materials.push_back({"shine", shine});
        knot.material = 2;
        knot.world_from_object = Affine3::translate({-1.2, 1, 0.4}) * Affine3::scale({0.2, 0.2, 0.2});
        scenes.push_back(test);
        // A third of its triangles shine by the mesh's own material, and reflect as the others do.
        test.meshes[0] = own_lamp({0.5f, 0.5f, 0.5f});
        test.description.objects.back().material.reset();
        scenes.push_back(test);
    }
    return scenes;
}

// Mean of the picture's green, with the standard error of replicates.
std::pair<double, double> mean_by(const TestScene& test, LightSearch search)
{
    ThreadPool pool(2);
    const tests::ReadyScene ready = tests::make_ready(test, pool);
    constexpr std::uint32_t kReplicates = 8, kSamples = 64;
    const ImageSettings& image = test.settings.image;
    double sum = 0, squares = 0;
    for (std::uint32_t r = 0; r < kReplicates; ++r) {
        double one = 0;
        RayTally tally;
        for (std::uint32_t y = 0; y < image.height_px; ++y)
            for (std::uint32_t x = 0; x < image.width_px; ++x) {
                const PixelSampler sampler(100 + r, x, y);
                std::vector<CameraSample> samples;
                for (std::uint32_t s = 0; s < kSamples; ++s) {
                    const Sample2 u = sampler.sample_2d(s, 0);
                    samples.push_back({ready.scene->camera().ray(
                                           x + static_cast<double>(u.u0), y + static_cast<double>(u.u1), {}),
                                       &sampler,
                                       s});
                }
                std::vector<Rgb> radiance(kSamples);
                PathLimits limits;
                limits.max_depth = ready.plan.max_depth;
                limits.search = search;
                path_radiance(*ready.scene, limits, samples, radiance, tally, {});
                for (const Rgb& c : radiance)
                    one += static_cast<double>(c.g);
            }
        one /= kSamples * image.width_px * image.height_px;
        sum += one;
        squares += one * one;
    }
    const double mean = sum / kReplicates;
    return {mean, std::sqrt(std::max(0.0, squares / kReplicates - mean * mean) / (kReplicates - 1))};
}

} // namespace

TEST(Path, FindsTheSameLightByAskingLightsByTheMaterialsRaysAndByBoth)
{
    int number = 0;
    for (TestScene& test : scenes_with_extended_lights()) {
        test.description.transport.type = TransportType::path;
        const auto both = mean_by(test, LightSearch::both), lights = mean_by(test, LightSearch::lights),
                   material = mean_by(test, LightSearch::material);
        const auto apart = [](auto a, auto b) {
            return 4 * std::sqrt(a.second * a.second + b.second * b.second);
        };
        EXPECT_GT(both.first, 0.01) << number;
        EXPECT_NEAR(both.first, lights.first, apart(both, lights)) << number;
        EXPECT_NEAR(both.first, material.first, apart(both, material)) << number;
        EXPECT_LT(both.second, 0.02 * both.first) << number;
        ++number;
    }
}

TEST(Path, TakesAMeshThatShinesByItsOwnMaterialForTheSameAsAnEmitter)
{
    TestScene test = scenes_with_extended_lights().back();
    Mesh whole = tests::knot(24, 6);
    whole.materials.resize(1);
    whole.materials[0].diffuse = {0, 0, 0};
    whole.materials[0].emission = {3, 3, 3};
    test.meshes[0] = whole;
    test.settings.quality.samples = 16;
    TestScene emitter = test;
    emitter.description.objects.back().material = 2;
    std::get<EmitterMaterial>(emitter.description.materials[2].material).two_sided = true;
    const auto own = tests::mean_of(render_description(test).film.mean());
    EXPECT_GT(own.g, 0.01f);
    EXPECT_EQ(own, tests::mean_of(render_description(emitter).film.mean()));
}

TEST(Path, IsTakenToALoneBodyThatReflectsASingleWayOrLetsLightIn)
{
    ConductorMaterial metal; // smooth unless it says otherwise
    CookTorranceMaterial varnish;
    varnish.base_color.value = {0.9f, 0.9f, 0.9f};
    varnish.metallic.value = 1;
    varnish.roughness.value = 0;
    GlassMaterial frosted;
    frosted.roughness.value = 0.3;
    for (const TransportType transport : {TransportType::automatic, TransportType::direct})
        for (const Material& material : {Material(metal), Material(varnish), Material(frosted)}) {
            const bool is_glass = std::holds_alternative<GlassMaterial>(material);
            if (is_glass && transport == TransportType::direct)
                continue; // light through it is scattered twice
            TestScene test;
            test.description.materials = {{"ball", material}};
            ObjectDescription& ball = test.description.objects.emplace_back();
            ball.shape = SphereShape{1};
            ball.material = 0;
            test.description.environment = ColorEnvironment{{1, 1, 1}};
            test.description.transport.type = transport;
            test.description.camera.emplace();
            test.description.camera->position = {0, 0, 4};
            test.description.camera->fov_deg = 10; // the ball fills the picture
            test.settings.image.width_px = test.settings.image.height_px = 8;
            test.settings.quality.samples = 64;
            const float seen = tests::mean_of(render_description(test).film.mean()).g;
            EXPECT_GT(seen, 0.8f);
            EXPECT_LT(seen, 1.001f);
        }
}
