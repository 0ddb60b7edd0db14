// Mirrors and glass followed as a tree, against closed forms; and the same scenes by paths.
#include "renderer/integrators/whitted.h"
#include "renderer/math/transcendental.h"
#include "tests/support/picture_error.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace renderer;
using tests::render_description;
using tests::TestScene;

namespace {

constexpr Rgb kSky{1, 1, 1};

// A ball before a sky of radiance 1 that fills the picture.
TestScene ball_before_the_sky(Material material, TransportType transport)
{
    TestScene test;
    SceneDescription& d = test.description;
    d.materials = {{"ball", std::move(material)}};
    ObjectDescription& ball = d.objects.emplace_back();
    ball.shape = SphereShape{1};
    ball.material = 0;
    d.environment = ColorEnvironment{kSky};
    d.transport.type = transport;
    d.camera.emplace();
    d.camera->position = {0, 0, 3};
    d.camera->fov_deg = 36;
    test.settings.image.width_px = test.settings.image.height_px = 24;
    test.settings.quality.samples = 16;
    return test;
}

GlassMaterial glass(double ior, std::uint32_t priority = 0)
{
    GlassMaterial m;
    m.ior = ior;
    m.priority = priority;
    return m;
}

double largest_difference(const LinearImage& a, const LinearImage& b)
{
    double most = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        most = std::max(most, static_cast<double>(std::abs(a.pixels[i].g - b.pixels[i].g)));
    return most;
}

} // namespace

TEST(Whitted, MirrorShowsTheSkyInFull)
{
    const LinearImage image =
        render_description(ball_before_the_sky(MirrorMaterial{}, TransportType::whitted)).film.mean();
    for (const Rgb& pixel : image.pixels)
        ASSERT_NEAR(pixel.g, 1, 1e-6f);
}

TEST(Whitted, GlassBeforeAnEvenSkyIsNotSeenButForWhatWasCut)
{
    TestScene test = ball_before_the_sky(glass(1.5), TransportType::whitted);
    test.description.transport.max_depth = 12;
    const RenderResult result = render_description(test);
    double mean = 0;
    for (const Rgb& pixel : result.film.mean().pixels) {
        ASSERT_LE(pixel.g, 1 + 1e-5f);
        mean += static_cast<double>(pixel.g);
    }
    mean /= static_cast<double>(result.film.mean().pixels.size());
    // The sky is 1 everywhere: what is missing is exactly the weight of the branches that were not followed.
    EXPECT_NEAR(mean + result.report.numerics.cut_weight, 1, 1e-5);
    EXPECT_LT(result.report.numerics.cut_weight, 1e-3);
}

TEST(Whitted, CutsAtItsDepthAndSaysHowMuch)
{
    TestScene test = ball_before_the_sky(glass(1.5), TransportType::whitted);
    test.description.transport.max_depth = 1;
    const RenderResult result = render_description(test);
    EXPECT_GT(result.report.numerics.cut_weight, 0.1);
    test.description.transport.max_depth = 0;
    const RenderResult none = render_description(test);
    EXPECT_GT(none.report.numerics.cut_weight, result.report.numerics.cut_weight);
}

TEST(Whitted, FollowsTwoMirrorsThatFaceEachOtherToAnyDepth)
{
    TestScene test;
    SceneDescription& d = test.description;
    MirrorMaterial mirror;
    mirror.color.value = {0.5f, 0.5f, 0.5f};
    PhongMaterial glowing;
    glowing.diffuse.value = glowing.specular.value = {};
    glowing.ambient = {1, 1, 1};
    d.materials = {{"mirror", mirror}, {"glow", glowing}};
    for (const double z : {-1.0, 1.0}) {
        ObjectDescription& wall = d.objects.emplace_back();
        wall.shape = RectangleShape{10, 10};
        wall.material = 0;
        wall.world_from_object = Affine3::translate({0, 0, z});
    }
    d.environment = NoEnvironment{};
    d.transport = {TransportType::whitted, 1000000, {}};
    d.camera.emplace();
    d.camera->fov_deg = 1;
    test.settings.image.width_px = test.settings.image.height_px = 2;
    test.settings.quality.samples = 1;
    const RenderResult result = render_description(test);
    // Halved at each: sixteen reflections until it carries less than is followed.
    EXPECT_NEAR(static_cast<double>(result.report.timing.bounce_rays) / 4, 16, 1);
    EXPECT_NEAR(result.report.numerics.cut_weight, 1.0 / 131072, 1e-6);
}

TEST(Whitted, AgreesWithPathsWhereThereIsNothingElse)
{
    for (const Material& material :
         {Material(MirrorMaterial{}), Material(glass(1.33)), Material(glass(1 / 1.5))}) {
        TestScene tree = ball_before_the_sky(material, TransportType::whitted), path = tree;
        tree.description.environment = path.description.environment = NoEnvironment{};
        for (TestScene* test : {&tree, &path}) {
            PhongMaterial wall;
            wall.diffuse.value = {0.8f, 0.2f, 0.2f};
            wall.specular.value = {};
            test->description.materials.push_back({"wall", wall});
            ObjectDescription& floor = test->description.objects.emplace_back();
            floor.shape = RectangleShape{40, 40};
            floor.material = 1;
            floor.world_from_object = Affine3::translate({0, 0, -5});
            test->description.lights.emplace_back(DirectionalLight{{-0.6, -0.5, -1}, {3, 3, 3}});
            test->description.transport.max_depth = 12;
            test->settings.quality.samples = 256;
        }
        tree.settings.quality.samples = 64;
        path.description.transport.type = TransportType::path;
        const LinearImage a = render_description(tree).film.mean(), b = render_description(path).film.mean();
        // One plane of diffuse matter lights nothing but itself seen in the ball: the same up to chance.
        EXPECT_NEAR(tests::mean_of(a).r / tests::mean_of(b).r, 1, 0.03);
    }
}

TEST(GlassBody, OfIndexOneIsNotThere)
{
    TestScene with = tests::kitchen_sink();
    with.description.transport.type = TransportType::path;
    with.settings.quality.samples = 2;
    TestScene without = with;
    with.description.materials.push_back({"nothing", glass(1)});
    ObjectDescription& ball = with.description.objects.emplace_back();
    ball.shape = SphereShape{1.2};
    ball.material = static_cast<std::uint32_t>(with.description.materials.size() - 1);
    EXPECT_EQ(tests::digest(render_description(with).film), tests::digest(render_description(without).film));
}

TEST(GlassBody, OfHigherPriorityFillsThePlaceWhereBodiesOverlap)
{
    // Water and glass in the very same place: only the glass is there.
    for (const TransportType transport : {TransportType::whitted, TransportType::path}) {
        TestScene alone = ball_before_the_sky(glass(1.5, 2), transport);
        alone.description.environment = NoEnvironment{};
        SunLight sun;
        sun.direction = {0.2, 0.1, 1};
        sun.angular_radius_deg = 40;
        alone.description.lights.emplace_back(sun);
        alone.description.transport.max_depth = 6;
        TestScene both = alone;
        both.description.materials.push_back({"water", glass(1.33, 1)});
        ObjectDescription& water = both.description.objects.emplace_back();
        water.shape = SphereShape{1};
        water.material = 1;
        const LinearImage a = render_description(alone).film.mean(), b = render_description(both).film.mean();
        EXPECT_LT(largest_difference(a, b), transport == TransportType::whitted ? 1e-4 : 1e-3);
        EXPECT_GT(tests::mean_of(a).g, 0.05f);
    }
}

// A smaller ball of water within a ball of glass.
struct Balls {
    Mesh glass = tests::faceted_sphere(24, 12), water = tests::faceted_sphere(24, 12);

    Balls()
    {
        for (Vec3f& position : water.positions)
            position = position * 0.5f;
        for (Mesh* mesh : {&glass, &water}) {
            mesh->materials.resize(1);
            mesh->materials[0].is_glass = true;
        }
        water.materials[0].ior = 1.33f;
        water.materials[0].absorption = {0.5f, 0, 0};
    }

    Mesh both_in_one() const
    {
        Mesh mesh = glass;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::size_t i = 0; i < water.positions.size(); ++i) {
            mesh.positions.push_back(water.positions[i]);
            mesh.normals.push_back(water.normals[i]);
        }
        mesh.triangle_materials.assign(mesh.triangles.size(), 0);
        for (const Triangle& t : water.triangles) {
            mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
            mesh.triangle_materials.push_back(1);
        }
        mesh.materials.push_back(water.materials[0]);
        return mesh;
    }
};

// The mesh's own glass, before a sky of one colour.
TestScene mesh_before_the_sky(const Mesh& mesh, TransportType transport, Rgb sky = {1, 1, 1})
{
    TestScene test = ball_before_the_sky(glass(1.5), transport);
    test.description.environment = ColorEnvironment{sky};
    test.description.transport.max_depth = 8;
    test.description.objects[0].shape = MeshShape{};
    test.description.objects[0].material.reset();
    test.meshes = {mesh};
    return test;
}

TEST(GlassBody, OfAMeshsOwnMaterialIsAsOneThatTheSceneNames)
{
    const Balls balls;
    for (const TransportType transport : {TransportType::whitted, TransportType::path}) {
        const TestScene own = mesh_before_the_sky(balls.glass, transport, {1, 0.5, 0.25});
        TestScene named = own;
        named.description.objects[0].material = 0;
        EXPECT_EQ(tests::digest(render_description(own).film), tests::digest(render_description(named).film));
    }
}

// Of index 1 all passes, straight, and through both boundaries of the ball.
TEST(GlassBody, OfAColourTintsWhatPassesEachOfItsBoundaries)
{
    const Balls balls;
    for (const double roughness : {0.0, 0.3})
        for (const TransportType transport : {TransportType::whitted, TransportType::path}) {
            if (roughness > 0 && transport == TransportType::whitted) continue;
            TestScene test = mesh_before_the_sky(balls.glass, transport);
            MeshMaterial& material = test.meshes[0].materials[0];
            material.ior = 1;
            material.is_physical = roughness > 0;
            material.roughness = static_cast<float>(roughness);
            material.transmission = {1, 0.5f, 0.25f};
            const LinearImage image = render_description(test).film.mean();
            const Rgb middle =
                image.pixels[std::size_t{image.height_px / 2} * image.width_px + image.width_px / 2];
            EXPECT_NEAR(middle.r, 1, 1e-5);
            EXPECT_NEAR(middle.g, 0.25, 1e-5);
            EXPECT_NEAR(middle.b, 0.0625, 1e-5);
        }
}

TEST(GlassBody, OfAPictureOfOneColourIsTintedAsOfThatColour)
{
    const Balls balls;
    constexpr Rgb kTint{1, 0.5f, 0.25f};
    for (const TransportType transport : {TransportType::whitted, TransportType::path}) {
        TestScene colour = mesh_before_the_sky(balls.glass, transport);
        Mesh& mesh = colour.meshes[0];
        mesh.uvs.assign(mesh.positions.size(), {0.5f, 0.5f});
        mesh.materials[0].is_physical = true;
        mesh.materials[0].roughness = 0;
        TestScene picture = colour;
        mesh.materials[0].transmission = kTint;
        Image image{1, 1, 3, PixelType::real_32, {}};
        image.bytes.append(std::as_bytes(std::span(&kTint, 1)));
        picture.meshes[0].images.push_back({"tint", image});
        picture.meshes[0].materials[0].color_map = TextureUse();
        EXPECT_EQ(tests::digest(render_description(picture).film),
                  tests::digest(render_description(colour).film));
        const Rgb seen = tests::mean_of(render_description(picture).film.mean());
        EXPECT_GT(seen.r, 1.05f * seen.b);
    }
}

TEST(GlassBody, WithinAnotherOfTheSameMeshIsABodyOfItsOwn)
{
    const Balls balls;
    for (const TransportType transport : {TransportType::whitted, TransportType::path}) {
        TestScene one = mesh_before_the_sky(balls.both_in_one(), transport, {1, 0.5, 0.25}), apart = one;
        apart.meshes = {balls.glass, balls.water};
        apart.description.objects.push_back(apart.description.objects[0]);
        apart.description.objects[1].shape = MeshShape{.mesh = 1, .part = {}};
        const RenderResult a = render_description(apart), b = render_description(one);
        EXPECT_EQ(tests::digest(a.film), tests::digest(b.film));
        EXPECT_LT(tests::mean_of(a.film.mean()).r, 0.9f) << "the water absorbs";
        // And the eye is known to be in both.
        for (TestScene* test : {&apart, &one})
            test->description.camera->position = {0.01, 0.02, 0.03};
        EXPECT_EQ(tests::digest(render_description(apart).film), tests::digest(render_description(one).film));
    }
}

TEST(GlassBody, AroundTheEyeIsKnown)
{
    // Inside a ball of glass the sky is seen through its wall: nothing is lost but by its own reflection, which sees
    // the same sky. Radiance there is n^2 times that outside.
    TestScene test = ball_before_the_sky(glass(1.5), TransportType::path);
    test.description.camera->position = {0.1, 0.2, 0.3};
    test.description.camera->aim = {0.5, 1, -2};
    test.settings.quality.samples = 64;
    const RenderResult result = render_description(test);
    EXPECT_NEAR(tests::mean_of(result.film.mean()).g, 2.25f, 5e-3f);
    // And what it absorbs is lost on the way out.
    GlassMaterial dark = glass(1.0000001);
    dark.absorption = {1, 1, 1};
    test.description.materials[0].material = dark;
    test.description.camera->position = {0, 0, 0};
    EXPECT_NEAR(tests::mean_of(render_description(test).film.mean()).g, std::exp(-1.0f), 1e-4f);
}
