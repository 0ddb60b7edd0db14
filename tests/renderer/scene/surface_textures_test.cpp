// Pictures on surfaces: each shape the right way round, values at a point, tilted normals, holes.
#include "renderer/math/transcendental.h"
#include "renderer/scene/scene.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace renderer;
using tests::make_ready;
using tests::TestScene;

namespace {

// Red grows to the right and green upwards: a picture that says where it was looked up.
SharedImage compass(std::uint32_t side = 64)
{
    Image image{side, side, 3, PixelType::real_32, {}};
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const float texel[3] = {(static_cast<float>(x) + 0.5f) / static_cast<float>(side),
                                    1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(side),
                                    0.5f};
            image.bytes.append(std::as_bytes(std::span(texel)));
        }
    return std::make_shared<const Image>(std::move(image));
}

// Opaque on the left, a hole on the right.
SharedImage half_hole()
{
    Image image{2, 1, 4, PixelType::whole_8, {}};
    for (const int code : {255, 255, 255, 255, 255, 255, 255, 0})
        image.bytes.push_back(static_cast<std::byte>(code));
    return std::make_shared<const Image>(std::move(image));
}

SharedImage plain(Rgb color)
{
    Image image{1, 1, 3, PixelType::real_32, {}};
    image.bytes.append(std::as_bytes(std::span(&color, 1)));
    return std::make_shared<const Image>(std::move(image));
}

TextureUse clamped()
{
    TextureUse use;
    use.wrap = TextureWrap::clamp;
    return use;
}

TestScene textured(const Shape& shape, const SharedImage& image, const TextureUse& use = clamped())
{
    TestScene test;
    DiffuseMaterial material;
    material.color.texture = use;
    test.description.materials = {{"picture", material}};
    test.description.images = {{"picture.png", "", ""}};
    test.images = {image};
    ObjectDescription& object = test.description.objects.emplace_back();
    object.shape = shape;
    object.material = 0;
    return test;
}

std::optional<SceneHit> first_hit(const Scene& scene, Vec3d from, Vec3d direction)
{
    const Ray ray{from, normalize(direction)};
    SceneHit hit;
    if (scene.closest_hits({&ray, 1}, {&hit, 1}, RayKind::camera) == 0) return std::nullopt;
    return hit;
}

Rgb seen(const TestScene& test, Vec3d from, Vec3d direction, double width = 0)
{
    ThreadPool pool(1);
    const auto ready = make_ready(test, pool);
    const auto hit = first_hit(*ready.scene, from, direction);
    EXPECT_TRUE(hit);
    if (!hit) return {};
    BsdfRoom room;
    return ready.scene->surface_at(*hit, -direction, &room, width).bsdf->diffuse;
}

void expect_at(Rgb found, double u, double v)
{
    EXPECT_NEAR(found.r, u, 1e-3);
    EXPECT_NEAR(found.g, v, 1e-3);
}

Mesh square()
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

} // namespace

TEST(SurfaceTextures, LieOnRectangleAndDiskAsTheyAreSeenFromTheFront)
{
    expect_at(seen(textured(RectangleShape{2, 4}, compass()), {0.5, -1, 5}, {0, 0, -1}), 0.75, 0.25);
    expect_at(seen(textured(DiskShape{2}, compass()), {1, -1, 5}, {0, 0, -1}), 0.75, 0.25);
}

TEST(SurfaceTextures, LieOnEveryFaceOfABoxTheRightWayRound)
{
    const TestScene box = textured(BoxShape{{2, 2, 2}}, compass());
    expect_at(seen(box, {0.5, 0.6, 9}, {0, 0, -1}), 0.75, 0.8);
    expect_at(seen(box, {0.5, 0.6, -9}, {0, 0, 1}), 0.25, 0.8); // from behind +x is on the left
    expect_at(seen(box, {9, 0.6, 0.5}, {-1, 0, 0}), 0.25, 0.8); // from +x, +z is on the left
    expect_at(seen(box, {-9, 0.6, 0.5}, {1, 0, 0}), 0.75, 0.8);
    expect_at(seen(box, {0.5, 9, 0.6}, {0, -1, 0}), 0.75, 0.2); // from above +z is down
    expect_at(seen(box, {0.5, -9, 0.6}, {0, 1, 0}), 0.75, 0.8);
}

TEST(SurfaceTextures, LieOnASphereAsAGlobe)
{
    const TestScene globe = textured(SphereShape{1}, compass(512));
    expect_at(seen(globe, {0, 0, 9}, {0, 0, -1}), 0.5, 0.5);
    expect_at(seen(globe, {9, 0, 0}, {-1, 0, 0}), 0.75, 0.5);
    const double h = std::sqrt(0.5);
    expect_at(seen(globe, {0, h, 9}, {0, 0, -1}), 0.5, 0.75); // 45 degrees up
}

TEST(SurfaceTextures, GoByTheMeshsOwnCoordinates)
{
    TestScene test = textured(MeshShape{}, compass());
    test.meshes.push_back(square());
    expect_at(seen(test, {0.3, 0.2, 5}, {0, 0, -1}), 0.3, 0.2);
    expect_at(seen(test, {0.2, 0.7, 5}, {0, 0, -1}), 0.2, 0.7);
    test.description.objects[0].world_from_object = Affine3::scale({10, 10, 10});
    expect_at(seen(test, {3, 2, 5}, {0, 0, -1}), 0.3, 0.2);
}

TEST(SurfaceTextures, AreRepeatedByTheirScale)
{
    TextureUse use;
    use.scale_u = 3;
    use.scale_v = 2;
    expect_at(
        seen(textured(RectangleShape{1, 1}, compass(), use), {-0.5 + 0.5 / 3, -0.5 + 0.15, 5}, {0, 0, -1}),
        0.5,
        0.3);
}

TEST(SurfaceTextures, AreRefusedOnAMeshWithoutCoordinates)
{
    TestScene test = textured(MeshShape{}, compass());
    test.meshes.push_back(square());
    test.meshes[0].uvs.clear();
    ThreadPool pool(1);
    EXPECT_THROW(make_ready(test, pool), std::runtime_error);
}

TEST(SurfaceTextures, AreTheirMeanWhereThereIsNoRoomForMore)
{
    const TestScene test = textured(RectangleShape{1, 1}, compass());
    ThreadPool pool(1);
    const auto ready = make_ready(test, pool);
    const auto hit = first_hit(*ready.scene, {0.2, 0.2, 5}, {0, 0, -1});
    ASSERT_TRUE(hit);
    expect_at(ready.scene->surface_at(*hit, {0, 0, 1}).bsdf->diffuse, 0.5, 0.5);
}

// A ray that stands for much sees the mean of much; at a slant the same from farther off.
TEST(SurfaceTextures, AreFilteredToWhatTheRayStandsFor)
{
    Image stripes{256, 1, 1, PixelType::real_32, {}};
    for (int x = 0; x < 256; ++x) {
        const float value = static_cast<float>(x % 2);
        stripes.bytes.append(std::as_bytes(std::span(&value, 1)));
    }
    const TestScene test = textured(RectangleShape{1, 1}, std::make_shared<const Image>(stripes));
    const Vec3d on_a_texel{(100 + 0.5) / 256 - 0.5, 0, 5};
    EXPECT_NEAR(seen(test, on_a_texel, {0, 0, -1}).r, 0, 1e-6);
    EXPECT_NEAR(seen(test, on_a_texel, {0, 0, -1}, 1.0 / 256).r, 0, 1e-6);
    EXPECT_NEAR(seen(test, on_a_texel, {0, 0, -1}, 8.0 / 256).r, 0.5, 0.02);
}

TEST(SurfaceTextures, StayWithinWhatASurfaceCanReflect)
{
    const Rgb found = seen(textured(RectangleShape{1, 1}, plain({7, 0.5f, 2})), {0, 0, 5}, {0, 0, -1});
    EXPECT_EQ(found, (Rgb{1, 0.5f, 1}));
}

// 45 degrees towards growing u: whichever way the rectangle stands, seen from either side.
TEST(SurfaceTextures, TiltNormalsTowardsGrowingU)
{
    const float h = static_cast<float>(0.5 + 0.5 * std::sqrt(0.5));
    for (const double turn : {0.0, 30.0, 90.0, 200.0}) {
        TestScene test = textured(RectangleShape{2, 2}, plain({h, 0.5f, h}));
        std::get<DiffuseMaterial>(test.description.materials[0].material).surface.normal_map = clamped();
        test.description.objects[0].world_from_object = Affine3::rotate_deg(turn, {0, 0, 1});
        ThreadPool pool(1);
        const auto ready = make_ready(test, pool);
        const auto [sine, cosine] = sin_cos_deg(turn);
        const Vec3d grows{cosine, sine, 0};
        for (const double side : {1.0, -1.0}) {
            const Vec3d toward{0, 0, side};
            const auto hit = first_hit(*ready.scene, toward * 5, -toward);
            ASSERT_TRUE(hit);
            BsdfRoom room;
            const Surface surface = ready.scene->surface_at(*hit, toward, &room);
            const Vec3d normal = to_double(surface.shading.to_world(Vec3f{0, 0, 1}));
            const Vec3d expected = normalize(grows + Vec3d{0, 0, 1}) * side;
            EXPECT_NEAR(length(normal - expected), 0, 1e-5) << turn << ' ' << side;
        }
    }
}

TEST(SurfaceTextures, KeepATiltedNormalOnTheViewersSide)
{
    TestScene test = textured(RectangleShape{2, 2}, plain({0, 0.5f, 0.5f}));
    std::get<DiffuseMaterial>(test.description.materials[0].material).surface.normal_map = clamped();
    ThreadPool pool(1);
    const auto ready = make_ready(test, pool);
    const Vec3d toward = normalize(Vec3d{1, 0, 0.05});
    const auto hit = first_hit(*ready.scene, toward * 5, -toward);
    ASSERT_TRUE(hit);
    BsdfRoom room;
    const Surface surface = ready.scene->surface_at(*hit, toward, &room);
    EXPECT_GT(surface.shading.to_local(to_float(toward)).z, 0);
}

TEST(SurfaceTextures, LetRaysThroughWhereAPictureHasHoles)
{
    TextureUse nearest = clamped();
    nearest.filter = TextureFilter::nearest;
    TestScene test = textured(RectangleShape{2, 2}, half_hole(), nearest);
    ObjectDescription& wall = test.description.objects.emplace_back();
    wall.shape = RectangleShape{2, 2};
    wall.world_from_object = Affine3::translate({0, 0, -1});
    ThreadPool pool(1);
    const auto ready = make_ready(test, pool);
    const auto solid = first_hit(*ready.scene, {-0.5, 0, 5}, {0, 0, -1});
    const auto through = first_hit(*ready.scene, {0.5, 0, 5}, {0, 0, -1});
    ASSERT_TRUE(solid && through);
    EXPECT_EQ(solid->instance, 0u);
    EXPECT_NEAR(solid->t, 5, 1e-12);
    EXPECT_EQ(through->instance, 1u);
    EXPECT_NEAR(through->t, 6, 1e-12);

    const auto is_shadowed = [&](double x, double far) {
        const Ray ray{{x, 0, 5}, {0, 0, -1}, 0, far};
        return ready.scene->any_hits({&ray, 1}) != 0;
    };
    EXPECT_TRUE(is_shadowed(-0.5, 5.5));
    EXPECT_FALSE(is_shadowed(0.5, 5.5)); // ends before the wall
    EXPECT_TRUE(is_shadowed(0.5, 7));
}

TEST(SurfaceTextures, GiveAMeshItsOwnPictures)
{
    TestScene test;
    Mesh mesh = square();
    mesh.materials.resize(1);
    mesh.materials[0].diffuse = {0.5f, 1, 1};
    mesh.materials[0].color_map = clamped();
    mesh.images.push_back({"compass", *compass()});
    test.meshes.push_back(std::move(mesh));
    test.description.objects.emplace_back().shape = MeshShape{};
    expect_at(seen(test, {0.3, 0.2, 5}, {0, 0, -1}), 0.5 * 0.3, 0.2); // times the file's colour
}

// A picture of one colour is that colour: to the bit, wherever light comes from.
TEST(SurfaceTextures, OfOneColourAreThatColour)
{
    TestScene picture = textured(SphereShape{1}, plain({0.25f, 0.5f, 0.75f}));
    picture.settings.image.width_px = picture.settings.image.height_px = 16;
    picture.settings.quality.samples = 4;
    TestScene constant = picture;
    constant.description.materials[0].material = DiffuseMaterial{{{0.25f, 0.5f, 0.75f}}};
    EXPECT_EQ(tests::digest(tests::render_description(picture).film),
              tests::digest(tests::render_description(constant).film));
}
