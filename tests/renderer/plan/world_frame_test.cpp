#include "renderer/plan/explain_numerics.h"
#include "renderer/plan/world_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

using namespace renderer;
using testing::HasSubstr;

namespace {

SceneDescription one_ball(double radius, Vec3d at, Vec3d eye)
{
    SceneDescription scene;
    ObjectDescription& object = scene.objects.emplace_back();
    object.shape = SphereShape{radius};
    object.world_from_object = Affine3::translate(at);
    scene.camera.emplace();
    scene.camera->position = eye;
    scene.camera->aim = at;
    return scene;
}

SceneDescription one_mesh()
{
    SceneDescription scene = one_ball(1, {}, {0, 0, 4});
    scene.objects[0].shape = MeshShape{};
    return scene;
}

ModelReport explained(const SceneDescription& scene, const MeshFacts& facts)
{
    ModelReport models;
    explain_numerics(
        scene, std::span(&facts, 1), {}, choose_world_origin(scene, std::span(&facts, 1)), models);
    return models;
}

} // namespace

TEST(WorldFrame, IsTheWorldsForScenesAtHome)
{
    EXPECT_EQ(choose_world_origin(one_ball(1, {0, 0, 0}, {0, 1, 5}), {}), Vec3d{});
    EXPECT_EQ(choose_world_origin(one_ball(1e-6, {1e-6, 0, 0}, {0, 1e-6, 5e-6}), {}), Vec3d{});
    EXPECT_EQ(choose_world_origin(one_ball(1, {100, 0, 20}, {100, 1, 25}), {}), Vec3d{});
    EXPECT_EQ(choose_world_origin(one_ball(6.36e6, {0, 0, 0}, {0, 6.36e6 + 1, 0}), {}), Vec3d{})
        << "a planet";
    SceneDescription nothing = one_ball(1, {}, {1e9, 0, 0});
    nothing.objects.clear();
    EXPECT_EQ(choose_world_origin(nothing, {}), Vec3d{});
}

TEST(WorldFrame, MovesWithTheSceneToTheBit)
{
    for (const double step : {0x1p20, 0x1p30, 0x1p50}) {
        const Vec3d by = Vec3d{1, -1, 3} * step;
        EXPECT_EQ(choose_world_origin(one_ball(1, by, by + Vec3d{0, 1, 5}), {}), by);
    }
    const Vec3d eye{1.23456789e9, -7.7e8, 42};
    const Vec3d origin = choose_world_origin(one_ball(1, eye + Vec3d{0, 0, -4}, eye), {});
    EXPECT_LT(length(eye - origin), 1e4) << "near the camera";
    for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_EQ(std::fmod(origin[axis], 1024), 0) << "exact to subtract";
}

TEST(WorldFrame, GoesByWhatIsNearestToTheCamera)
{
    SceneDescription scene = one_ball(0.5, {1e9, 0, 0}, {1e9, 0, 3});
    ObjectDescription& far = scene.objects.emplace_back();
    far.shape = SphereShape{1e8};
    EXPECT_NE(choose_world_origin(scene, {}), Vec3d{});
    scene.objects.erase(scene.objects.begin());
    EXPECT_EQ(choose_world_origin(scene, {}), Vec3d{});
}

TEST(ExplainNumerics, TellsWhichCornersAreMoreThanFloatsAndWhy)
{
    MeshFacts facts;
    facts.bounds = {{-1, -1, -1}, {1, 1, 1}};
    ModelReport models = explained(one_mesh(), facts);
    ASSERT_EQ(models.used.size(), 1u);
    EXPECT_EQ(models.used[0].name, "float_corners");
    EXPECT_EQ(models.used[0].why.find("pixel"), std::string::npos) << "nothing that could be seen";
    EXPECT_EQ(corner_precision(one_mesh(), std::span(&facts, 1)), "float");

    facts.bounds = {{-1e6, -1e6, -1e6}, {1e6, 1e6, -1}}; // seen from 5 m
    models = explained(one_mesh(), facts);
    ASSERT_EQ(models.used.size(), 1u);
    EXPECT_THAT(models.used[0].why, HasSubstr("a corner may be off by 0.0596 m"));

    facts.has_residuals = true;
    facts.origin = {1e9, 0, 0};
    facts.bounds = {{1e9 - 1, -1, -1}, {1e9 + 1, 1, 1}};
    SceneDescription there = one_mesh();
    there.camera->position = {1e9, 0, 4};
    models = explained(there, facts);
    ASSERT_EQ(models.used.size(), 3u);
    EXPECT_EQ(models.used[0].name, "recentred_scene");
    EXPECT_EQ(models.used[1].name, "recentred_meshes");
    EXPECT_EQ(models.used[2].name, "double_corners");
    EXPECT_EQ(corner_precision(there, std::span(&facts, 1)), "double");
    EXPECT_EQ(corner_precision(one_ball(1, {}, {0, 0, 4}), {}), "double") << "a sphere is exact";
}
