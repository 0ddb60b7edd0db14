#include "renderer/camera/camera.h"
#include "renderer/description/fault_list.h"
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
using renderer::Fault;
using renderer::Limits;
using renderer::make_plan;
using renderer::MeshFacts;
using renderer::ModelChoice;
using renderer::ObjectDescription;
using renderer::Plan;
using renderer::RenderSettings;
using renderer::SceneDescription;
using renderer::Vec3d;
using tests::cube_facts;
using tests::names;
using tests::one_mesh;

namespace {

std::vector<Fault> faults_of(const SceneDescription& scene,
                             const std::vector<MeshFacts>& meshes,
                             const RenderSettings& settings = {},
                             const Limits& limits = {})
{
    const auto result = make_plan(assume_defaults(scene, meshes, 4.0 / 3), meshes, settings, limits);
    const auto* const faults = std::get_if<std::vector<Fault>>(&result);
    return faults != nullptr ? *faults : std::vector<Fault>{};
}

Plan plan_of(const SceneDescription& scene,
             const std::vector<MeshFacts>& meshes,
             const RenderSettings& settings = {})
{
    const auto result = make_plan(assume_defaults(scene, meshes, 4.0 / 3), meshes, settings, {});
    EXPECT_TRUE(std::holds_alternative<Plan>(result));
    return std::get<Plan>(result);
}

} // namespace

TEST(MakePlan, NamesEveryFaultAtOnceWithItsPointer)
{
    MeshFacts facts = cube_facts();
    facts.parts = {{"lid", {0, 2, {}}}, {"body", {2, 10, {}}}};
    SceneDescription scene = one_mesh();
    scene.objects[0].shape = renderer::MeshShape{0, "lit"};
    scene.objects.emplace_back().world_from_object = Affine3::scale({1, 0, 1});
    scene.objects.back().shape = renderer::SphereShape{};
    scene.camera.emplace();
    scene.camera->fov_deg = 180;
    scene.camera->aim = scene.camera->position;
    scene.lights.emplace_back(renderer::DirectionalLight{{0, 0, 0}, {1, 1, 1}});
    RenderSettings settings;
    settings.image.region = renderer::PixelRect{700, 0, 101, 600};

    const auto faults = faults_of(scene, {facts}, settings);
    std::vector<std::string> pointers;
    for (const Fault& fault : faults) {
        pointers.push_back(fault.pointer);
        EXPECT_FALSE(fault.detail.empty());
    }
    EXPECT_THAT(pointers,
                ElementsAre("/scene/camera/fov_deg",
                            "/scene/camera/look_at",
                            "/scene/objects/0/part",
                            "/scene/objects/1/transform",
                            "/scene/lights/0/direction",
                            "/image/region"));
    EXPECT_THAT(faults[2].detail, AllOf(HasSubstr("\"lid\""), HasSubstr("\"body\"")));
}

TEST(MakePlan, RefusesFieldsOfViewThatAreNone)
{
    SceneDescription scene = one_mesh();
    for (const double fov : {0.0, 180.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        scene.camera.emplace();
        scene.camera->fov_deg = fov;
        const auto faults = faults_of(scene, {cube_facts()});
        ASSERT_EQ(faults.size(), 1u) << fov;
        EXPECT_EQ(faults[0].pointer, "/scene/camera/fov_deg");
    }
    for (const double fov : {0.01, 179.9}) {
        scene.camera->fov_deg = fov;
        EXPECT_TRUE(faults_of(scene, {cube_facts()}).empty());
    }
}

TEST(MakePlan, RefusesPicturesWithoutPixels)
{
    for (const bool flat : {false, true}) {
        RenderSettings settings;
        (flat ? settings.image.height_px : settings.image.width_px) = 0;
        const auto faults = faults_of(one_mesh(), {cube_facts()}, settings);
        ASSERT_EQ(faults.size(), 1u);
        EXPECT_EQ(faults[0].pointer, flat ? "/image/height" : "/image/width");
    }
}

TEST(MakePlan, RefusesWhatIsOverALimitWithTheNumber)
{
    MeshFacts big = cube_facts();
    big.triangles = 50'000'001;
    const auto triangles = faults_of(one_mesh(), {big}, {}, Limits::none());
    EXPECT_TRUE(triangles.empty());
    const auto refused = faults_of(one_mesh(), {big});
    ASSERT_FALSE(refused.empty());
    EXPECT_EQ(refused[0].code, "over_limit");
    EXPECT_THAT(refused[0].detail, AllOf(HasSubstr("50000001"), HasSubstr("50000000")));

    RenderSettings huge;
    huge.image.width_px = huge.image.height_px = 32768;
    Limits limits;
    limits.image_pixels = 1ull << 40;
    const auto memory = faults_of(one_mesh(), {cube_facts()}, huge, limits);
    ASSERT_EQ(memory.size(), 1u);
    EXPECT_EQ(memory[0].pointer, "/image");
    EXPECT_THAT(memory[0].detail, HasSubstr("render_memory_bytes"));
    huge.image.region = renderer::PixelRect{0, 0, 16, 16}; // a crop costs only itself
    EXPECT_TRUE(faults_of(one_mesh(), {cube_facts()}, huge, limits).empty());
}

TEST(MakePlan, RefusesPlacesBeyondItsReach)
{
    SceneDescription scene = one_mesh();
    scene.objects[0].world_from_object = Affine3::translate({1e19, 0, 0});
    const auto faults = faults_of(scene, {cube_facts()});
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].pointer, "/scene/objects/0/transform");
}

TEST(MakePlan, ExplainsWhatItUsesAndWhatItLeavesOut)
{
    MeshFacts facts = cube_facts();
    facts.has_normals = facts.has_materials = facts.has_textures = true;
    SceneDescription scene = one_mesh();
    const Plan plan = plan_of(scene, {facts});
    EXPECT_THAT(names(plan.models.used),
                IsSupersetOf({"assumed_camera",
                              "assumed_sky",
                              "assumed_sun",
                              "path",
                              "watertight_triangles",
                              "smooth_normals",
                              "diffuse",
                              "directional_lights",
                              "environment_light"}));
    EXPECT_THAT(names(plan.models.skipped), UnorderedElementsAre("two_level_bvh", "textures"));

    scene.materials.push_back({"shiny", renderer::PhongMaterial{}});
    scene.objects[0].material = 0;
    scene.objects[0].shading = renderer::Shading::flat;
    scene.objects.emplace_back().shape = renderer::SphereShape{};
    scene.lights.emplace_back(renderer::SpotLight{});
    const Plan other = plan_of(scene, {facts});
    EXPECT_THAT(names(other.models.used),
                IsSupersetOf({"two_level_bvh",
                              "phong_normalized",
                              "exact_spheres",
                              "default_diffuse",
                              "spot_lights",
                              "hard_shadows"}));
    EXPECT_THAT(names(other.models.skipped),
                UnorderedElementsAre("mesh_attributes", "smooth_normals", "environment_light"));
}

TEST(MakePlan, TellsOfTwoLevelsOnlyWhereOneTreeStandsOverOthers)
{
    const auto told = [](const SceneDescription& scene) {
        const Plan plan = plan_of(scene, {cube_facts()});
        const auto is_it = [](const ModelChoice& choice) { return choice.name == "two_level_bvh"; };
        EXPECT_NE(std::any_of(plan.models.used.begin(), plan.models.used.end(), is_it),
                  std::any_of(plan.models.skipped.begin(), plan.models.skipped.end(), is_it));
        return std::any_of(plan.models.used.begin(), plan.models.used.end(), is_it);
    };
    SceneDescription scene;
    EXPECT_FALSE(told(scene));
    scene.objects.emplace_back().shape = renderer::SphereShape{};
    EXPECT_FALSE(told(scene));
    scene = one_mesh();
    scene.objects[0].world_from_object = Affine3::translate({1, 2, 3});
    EXPECT_FALSE(told(scene));
    scene.objects.push_back(scene.objects[0]); // both are joined
    EXPECT_FALSE(told(scene));
    scene.objects.emplace_back().shape = renderer::SphereShape{};
    EXPECT_TRUE(told(scene));
}

TEST(MakePlan, TellsWhatAccelerationIsAskedToLeaveOut)
{
    SceneDescription scene = one_mesh();
    scene.objects.emplace_back().shape = renderer::BoxShape{};
    RenderSettings settings;
    settings.image.width_px = settings.image.height_px = 100;
    settings.quality.samples = 5;
    settings.acceleration.levels = renderer::BvhLevels::mesh;
    settings.acceleration.split = renderer::BvhSplit::midpoint;
    settings.acceleration.width = renderer::BvhWidth::binary;
    const Plan plan = plan_of(scene, {cube_facts()}, settings);
    EXPECT_THAT(names(plan.models.used), IsSupersetOf({"object_list", "binary_bvh", "midpoint_split"}));
    EXPECT_THAT(names(plan.models.skipped), Contains("two_level_bvh"));

    settings.acceleration.levels = renderer::BvhLevels::none;
    const Plan none = plan_of(scene, {cube_facts()}, settings);
    EXPECT_THAT(names(none.models.used), Not(Contains("binary_bvh")));
    const auto& used = none.models.used;
    const auto list = std::find_if(
        used.begin(), used.end(), [](const ModelChoice& c) { return c.name == "triangle_list"; });
    ASSERT_NE(list, used.end());
    EXPECT_THAT(list->why, HasSubstr("24 in all: 1.2e+06 tests")); // 100 x 100 pixels, 5 samples, two boxes
}

TEST(MakePlan, ListsAThousandFaultsAndCountsTheOthers)
{
    SceneDescription scene;
    for (int i = 0; i < 2500; ++i)
        scene.objects.emplace_back().shape = renderer::SphereShape{-1};
    const auto faults = faults_of(scene, {});
    ASSERT_EQ(faults.size(), renderer::kMostFaults + 1);
    EXPECT_EQ(faults.back(), renderer::more_faults(1500));
}

TEST(MakePlan, FindsAPartAmongAsManyAsThereAreObjects)
{
    MeshFacts facts = cube_facts();
    SceneDescription scene = one_mesh();
    scene.objects.clear();
    for (std::uint32_t i = 0; i < 100'000; ++i) { // ten thousand million comparisons, were each looked at
        facts.parts["part" + std::to_string(i)] = {0, 1, facts.bounds};
        scene.objects.emplace_back().shape = renderer::MeshShape{0, "part" + std::to_string(i)};
    }
    EXPECT_TRUE(faults_of(scene, {facts}).empty());
}

TEST(MakePlan, CountsTheMaterialsWhoseLightTransparencyOrMetalIsLeftOut)
{
    MeshFacts facts = cube_facts();
    facts.has_materials = true;
    facts.emissive_materials = 1;
    facts.transparent_materials = 2;
    facts.metal_materials = 3;
    facts.rough_materials = 4;
    SceneDescription scene = one_mesh();
    scene.objects.push_back(scene.objects[0]); // the same mesh again: the same materials
    const auto why = [](const Plan& plan, const std::string& name) {
        for (const ModelChoice& choice : plan.models.skipped)
            if (choice.name == name) return choice.why;
        return std::string();
    };
    const Plan plan = plan_of(scene, {facts});
    EXPECT_THAT(why(plan, "emission"), StartsWith("1 material "));
    EXPECT_THAT(why(plan, "transparency"), StartsWith("2 materials "));
    EXPECT_THAT(why(plan, "metal"), StartsWith("3 materials "));
    EXPECT_THAT(why(plan, "roughness"), StartsWith("4 materials "));

    scene.materials.push_back({"own", renderer::DiffuseMaterial{}});
    for (ObjectDescription& object : scene.objects)
        object.material = 0;
    for (const char* name : {"emission", "transparency", "metal", "roughness"})
        EXPECT_EQ(why(plan_of(scene, {facts}), name), "") << "the mesh's own materials are not shown";
}

TEST(FactsOf, CountsOnlyMaterialsThatATriangleHas)
{
    renderer::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 2}};
    mesh.materials.resize(3);
    for (renderer::MeshMaterial& material : mesh.materials)
        material.emits = material.is_transparent = material.is_metal = material.has_roughness = true;
    EXPECT_EQ(renderer::facts_of(mesh).emissive_materials, 1u); // none given: all have the first
    mesh.triangle_materials = {2, 0};
    const MeshFacts facts = renderer::facts_of(mesh);
    EXPECT_EQ(facts.emissive_materials, 2u);
    EXPECT_EQ(facts.shining_materials, 0u);
    EXPECT_EQ(facts.transparent_materials, 2u);
    EXPECT_EQ(facts.metal_materials, 2u);
    EXPECT_EQ(facts.rough_materials, 2u);
}

TEST(MakePlan, TakesMeshesOfGlassForWhatTheyAre)
{
    renderer::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 2}};
    mesh.materials.resize(2);
    mesh.materials[0].is_glass = true;
    SceneDescription scene = one_mesh();
    scene.lights.emplace_back(renderer::PointLight{});
    const auto uses = [&](const std::string& name) {
        const Plan plan = plan_of(scene, {renderer::facts_of(mesh)});
        return std::any_of(plan.models.used.begin(), plan.models.used.end(), [&](const ModelChoice& choice) {
            return choice.name == name;
        });
    };
    EXPECT_TRUE(uses("dielectric_fresnel"));
    EXPECT_FALSE(uses("rough_glass"));
    EXPECT_FALSE(uses("diffuse"));
    EXPECT_EQ(plan_of(scene, {renderer::facts_of(mesh)}).integrator, renderer::Integrator::whitted);
    mesh.triangle_materials = {0, 1};
    EXPECT_TRUE(uses("dielectric_fresnel"));
    EXPECT_TRUE(uses("diffuse"));
    mesh.materials[0].is_physical = true;
    mesh.materials[0].roughness = 0.3f;
    EXPECT_TRUE(uses("rough_glass"));
    EXPECT_EQ(plan_of(scene, {renderer::facts_of(mesh)}).integrator, renderer::Integrator::path);
    scene.materials.push_back({"own", renderer::DiffuseMaterial{}});
    scene.objects[0].material = 0;
    EXPECT_FALSE(uses("rough_glass")) << "the mesh's own materials are not shown";
}

TEST(MakePlan, CountsTrianglesThatShineAsLights)
{
    renderer::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}};
    mesh.materials.resize(2);
    mesh.materials[1].emission = {1, 2, 3};
    EXPECT_EQ(renderer::facts_of(mesh).shining_triangles, 0u); // none given: all have the first
    mesh.triangle_materials = {1, 0, 1};
    const MeshFacts facts = renderer::facts_of(mesh);
    EXPECT_EQ(facts.shining_triangles, 2u);
    EXPECT_EQ(facts.shining_materials, 1u);

    SceneDescription scene = one_mesh();
    const auto shines = [&] {
        const Plan plan = plan_of(scene, {facts});
        return std::any_of(plan.models.used.begin(), plan.models.used.end(), [](const ModelChoice& choice) {
            return choice.name == "mesh_emission";
        });
    };
    EXPECT_TRUE(shines());
    EXPECT_EQ(plan_of(scene, {facts}).integrator, renderer::Integrator::path);
    scene.materials.push_back({"own", renderer::DiffuseMaterial{}});
    scene.objects[0].material = 0;
    EXPECT_FALSE(shines()) << "the mesh's own materials are not shown";
}
