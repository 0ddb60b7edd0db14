// What is filled in that a description leaves open.
#include "renderer/camera/camera.h"
#include "renderer/math/transcendental.h"
#include "renderer/plan/plan.h"
#include "renderer/plan/world_bounds.h"
#include "tests/renderer/plan/one_cube.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace testing;
using renderer::Affine3;
using renderer::assume_defaults;
using renderer::AssumedScene;
using renderer::MeshFacts;
using renderer::SceneDescription;
using renderer::Vec3d;
using tests::cube_facts;
using tests::names;
using tests::one_mesh;

TEST(AssumeDefaults, FramesTheWholeSceneFromTheSameSideForEveryAspect)
{
    const std::vector<MeshFacts> meshes{cube_facts()};
    SceneDescription scene = one_mesh();
    scene.objects[0].world_from_object =
        Affine3::translate({100, 20, -7}) * Affine3::rotate_deg(33, {1, 2, 0});
    for (const double aspect : {0.25, 0.5, 1.0, 4.0 / 3, 3.0}) {
        const AssumedScene assumed = assume_defaults(scene, meshes, aspect);
        const auto& camera = *assumed.description.camera;
        const renderer::Camera pinhole(camera, static_cast<std::uint32_t>(1200 * aspect), 1200);
        EXPECT_NEAR(dot(pinhole.forward(), normalize(Vec3d{-0.35, -0.3, -1})), 1, 1e-12);
        const double tan_y = renderer::tan_deg(camera.fov_deg / 2);
        double widest = 0;
        for (const Vec3d& corner : world_corners(scene.objects[0], meshes)) {
            const Vec3d c = corner - camera.position;
            const double depth = dot(c, pinhole.forward());
            ASSERT_GT(depth, 0);
            widest = std::max({widest,
                               std::abs(dot(c, pinhole.right())) / (depth * tan_y * aspect),
                               std::abs(dot(c, pinhole.up())) / (depth * tan_y)});
        }
        EXPECT_LT(widest, 0.97) << aspect;
        EXPECT_GT(widest, 0.8) << aspect; // and not from far away
    }
}

TEST(AssumeDefaults, FramesTheSameAtEveryScale)
{
    const std::vector<MeshFacts> meshes{cube_facts()};
    for (const double scale : {1e-6, 1e-3, 1.0, 1e6}) {
        SceneDescription scene = one_mesh();
        scene.objects[0].world_from_object = Affine3::scale({scale, scale, scale});
        const double distance =
            length(assume_defaults(scene, meshes, 1).description.camera->position) / scale;
        EXPECT_NEAR(
            distance, length(assume_defaults(one_mesh(), meshes, 1).description.camera->position), 1e-9);
    }
}

TEST(AssumeDefaults, FramesThePartThatIsShown)
{
    MeshFacts facts = cube_facts();
    facts.parts = {{"lid", {0, 2, {{0.5f, 1, 1}, {1, 2, 2}}}}};
    SceneDescription scene = one_mesh();
    scene.objects[0].shape = renderer::MeshShape{0, "lid"};
    const auto camera = *assume_defaults(scene, std::vector{facts}, 1).description.camera;
    EXPECT_EQ(camera.aim, (Vec3d{0.75, 1.5, 1.5}));
}

TEST(AssumeDefaults, LightsOnlyASceneThatNothingLights)
{
    const std::vector<MeshFacts> meshes{cube_facts()};
    const AssumedScene dark = assume_defaults(one_mesh(), meshes, 1);
    EXPECT_THAT(names(dark.assumed), ElementsAre("assumed_camera", "assumed_sky", "assumed_sun"));
    EXPECT_EQ(dark.description.lights.size(), 1u);

    SceneDescription lit = one_mesh();
    lit.lights.emplace_back(renderer::PointLight{});
    const AssumedScene kept = assume_defaults(lit, meshes, 1);
    EXPECT_THAT(names(kept.assumed), ElementsAre("assumed_camera"));
    EXPECT_TRUE(std::holds_alternative<renderer::NoEnvironment>(*kept.description.environment));

    SceneDescription black = one_mesh();
    black.environment = renderer::NoEnvironment{}; // said, so kept
    EXPECT_TRUE(assume_defaults(black, meshes, 1).description.lights.empty());
}

TEST(AssumeDefaults, LightsWhiteWithoutClipping)
{
    const AssumedScene scene = assume_defaults(one_mesh(), std::vector{cube_facts()}, 1);
    const auto sky = std::get<renderer::ColorEnvironment>(*scene.description.environment).radiance;
    const auto sun = std::get<renderer::DirectionalLight>(scene.description.lights[0]).irradiance;
    const auto pi = static_cast<float>(renderer::kPi);
    for (const float white : {sky.r + sun.r / pi, sky.g + sun.g / pi, sky.b + sun.b / pi}) {
        EXPECT_LE(white, 1);
        EXPECT_GE(white, 0.85f);
    }
}

TEST(AssumeDefaults, HasACameraForAPointAndForNothing)
{
    SceneDescription empty;
    EXPECT_EQ(assume_defaults(empty, {}, 1).description.camera->position, (Vec3d{0, 0, 0}));
    MeshFacts point;
    point.bounds = {{5, 5, 5}, {5, 5, 5}};
    const auto camera = *assume_defaults(one_mesh(), std::vector{point}, 1).description.camera;
    EXPECT_GT(length(camera.position - camera.aim), 0);
}
