#include "renderer/math/transcendental.h"
#include "renderer/scene/scene.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace renderer;
using tests::make_ready;
using tests::TestScene;

namespace {

// Two triangles side by side in the xy plane, with materials and parts of their own.
Mesh two_colours()
{
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {-0.5f, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    mesh.triangle_materials = {0, 1};
    mesh.materials.resize(2);
    mesh.materials[0].diffuse = {1, 0, 0};
    mesh.materials[1].diffuse = {0.9f, 0.9f, 0.9f};
    mesh.materials[1].specular = {0.9f, 0.9f, 0.9f};
    mesh.materials[1].shininess = 20;
    mesh.parts = {{"left", 0, 1}, {"right", 1, 1}};
    return mesh;
}

std::optional<Surface> look_at(const Scene& scene, Vec3d from, Vec3d direction)
{
    const auto hit = scene.tree().closest_hit(Ray{from, direction}, RayKind::camera);
    if (!hit) return std::nullopt;
    return scene.surface_at(*hit, -direction);
}

TestScene scene_of(Mesh mesh)
{
    TestScene test;
    test.meshes.push_back(std::move(mesh));
    test.description.objects.emplace_back().shape = MeshShape{};
    return test;
}

} // namespace

TEST(Scene, UsesTheMeshsOwnMaterialsWhereTheObjectNamesNone)
{
    ThreadPool pool(1);
    TestScene test = scene_of(two_colours());
    const auto ready = make_ready(test, pool);
    const auto left = look_at(*ready.scene, {-0.5, 0.3, 5}, {0, 0, -1});
    const auto right = look_at(*ready.scene, {0.5, 0.3, 5}, {0, 0, -1});
    ASSERT_TRUE(left && right);
    EXPECT_EQ(left->bsdf->kind, BsdfKind::diffuse);
    EXPECT_EQ(left->bsdf->diffuse, (Rgb{1, 0, 0}));
    EXPECT_EQ(right->bsdf->kind, BsdfKind::phong_normalized);
    EXPECT_NEAR(right->bsdf->diffuse.r + right->bsdf->specular.r, 1, 1e-6); // dimmed so as not to gain energy

    test.description.materials = {{"blue", DiffuseMaterial{{0, 0, 1}}}};
    test.description.objects[0].material = 0;
    const auto painted = make_ready(test, pool);
    EXPECT_EQ(look_at(*painted.scene, {-0.5, 0.3, 5}, {0, 0, -1})->bsdf->diffuse, (Rgb{0, 0, 1}));
}

TEST(Scene, ShowsOnlyTheNamedPart)
{
    ThreadPool pool(1);
    TestScene test = scene_of(two_colours());
    test.description.objects[0].shape = MeshShape{0, "right"};
    const auto ready = make_ready(test, pool);
    EXPECT_FALSE(look_at(*ready.scene, {-0.5, 0.3, 5}, {0, 0, -1}));
    const auto right = look_at(*ready.scene, {0.5, 0.3, 5}, {0, 0, -1});
    ASSERT_TRUE(right);
    EXPECT_EQ(right->bsdf->kind, BsdfKind::phong_normalized); // the material of triangle 1, not of the first
}

TEST(Scene, SharesOneMeshAmongItsInstances)
{
    ThreadPool pool(1);
    TestScene test = scene_of(tests::knot());
    const auto one = make_ready(test, pool);
    for (int i = 0; i < 9; ++i) {
        test.description.objects.push_back(test.description.objects[0]);
        test.description.objects.back().world_from_object = Affine3::translate({10.0 * (i + 1), 0, 0});
    }
    const auto ten = make_ready(test, pool);
    EXPECT_EQ(ten.scene->geometry().triangles, test.meshes[0].triangles.size());
    EXPECT_EQ(ten.scene->geometry().instances, 10u);
    EXPECT_LT(ten.scene->geometry().bvh_bytes, one.scene->geometry().bvh_bytes * 3 / 2);
}

TEST(Scene, SharesATreeAmongPartsOfTheSameTriangles)
{
    ThreadPool pool(1);
    TestScene test = scene_of(tests::knot());
    Mesh& mesh = test.meshes[0];
    const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
    mesh.parts = {{"whole", 0, all}, {"half", 0, all / 2}, {"as half", 0, all / 2}, {"half", 0, 1}};
    const auto bvh_bytes = [&](const std::vector<const char*>& parts) {
        test.description.objects.clear();
        for (const char* part : parts)
            test.description.objects.emplace_back().shape = MeshShape{0, part};
        const auto ready = make_ready(test, pool);
        EXPECT_EQ(ready.scene->geometry().triangles, all);
        return ready.scene->geometry().bvh_bytes;
    };
    EXPECT_EQ(bvh_bytes({"", "whole"}), bvh_bytes({"", ""}));
    EXPECT_EQ(bvh_bytes({"half", "as half"}), bvh_bytes({"half", "half"}));
    EXPECT_GT(bvh_bytes({"half", ""}), bvh_bytes({"", ""})); // of two of one name, the first
}

TEST(Scene, IsNotMadeOnceAStopIsRequested)
{
    ThreadPool pool(1);
    TestScene test = scene_of(two_colours());
    test.description.objects[0].shape = MeshShape{0, "right"};
    const std::vector facts{facts_of(test.meshes[0])};
    const AssumedScene assumed = assume_defaults(test.description, facts, 1);
    const std::vector prepared{prepare_mesh(test.meshes[0], MeshTree::wide_sah, pool)};
    std::stop_source stop;
    EXPECT_TRUE(prepare(assumed, Plan{}, prepared, test.settings, pool, stop.get_token()));
    stop.request_stop();
    EXPECT_FALSE(prepare(assumed, Plan{}, prepared, test.settings, pool, stop.get_token()));
}

TEST(Scene, TurnsNormalsToTheViewerAlsoWhenMirrored)
{
    ThreadPool pool(1);
    for (const double mirror : {1.0, -1.0}) {
        TestScene test = scene_of(tests::faceted_sphere(64, 32));
        test.description.objects[0].world_from_object =
            Affine3::translate({5, 0, 0}) * Affine3::scale({mirror * 2, 1, 1});
        const auto ready = make_ready(test, pool);
        for (double degrees = 5; degrees < 360; degrees += 10) {
            const auto [s, c] = sin_cos_deg(degrees);
            const Vec3d out{c, 0.1, s};
            const auto outside = look_at(*ready.scene, Vec3d{5, 0, 0} + out * 10.0, -out);
            const auto inside = look_at(*ready.scene, {5, 0, 0}, out);
            ASSERT_TRUE(outside && inside);
            EXPECT_GT(dot(to_double(outside->geometric), out), 0);
            EXPECT_GT(dot(to_double(outside->shading.z), out), 0);
            EXPECT_LT(dot(to_double(inside->shading.z), out), 0);
            // The ellipsoid's true normal, as its transform makes it: (x/4, y, z).
            const Vec3d p = outside->point.position - Vec3d{5, 0, 0};
            const Vec3d want = normalize(Vec3d{p.x / 4, p.y, p.z});
            EXPECT_GT(dot(to_double(outside->shading.z), want), 0.995);
        }
    }
}

TEST(Scene, FallsBackToTheFaceWhereNormalsCancel)
{
    ThreadPool pool(1);
    Mesh mesh = two_colours();
    mesh.normals = {{0, 1, 0}, {0, -1, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    const auto ready = make_ready(scene_of(mesh), pool);
    const auto surface =
        look_at(*ready.scene, {-0.5, 1e-9, 5}, {0, 0, -1}); // midway between opposite normals
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->shading.z, (Vec3f{0, 0, 1}));
}

TEST(Scene, IsFlatWhenAskedTo)
{
    ThreadPool pool(1);
    TestScene test = scene_of(tests::faceted_sphere(8, 6));
    test.description.objects[0].shading = Shading::flat;
    const auto ready = make_ready(test, pool);
    const auto surface = look_at(*ready.scene, {0.31, 0.22, 5}, {0, 0, -1});
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->shading.z, surface->geometric);
}

TEST(Scene, ReportsHowFarFromTheOriginItStands)
{
    ThreadPool pool(1);
    TestScene test = scene_of(two_colours());
    test.description.objects[0].world_from_object = Affine3::translate({1e6, 0, 0});
    const double ratio = make_ready(test, pool).scene->numerics().coordinate_ratio;
    EXPECT_NEAR(ratio, 1e6 / std::sqrt(5.0), 10);
}

TEST(Scene, IsRefusedWithASingularTransform)
{
    ThreadPool pool(1);
    TestScene test = scene_of(two_colours());
    test.description.objects[0].world_from_object = Affine3::scale({1, 1, 0});
    EXPECT_THROW(make_ready(test, pool), std::runtime_error);
}
