#include "renderer/accel/mesh_bvh.h"
#include "renderer/film/layer_sums.h"
#include "renderer/plan/budget.h"
#include "renderer/plan/predict_cost.h"
#include "renderer/scene/scene_lights.h"
#include "tests/renderer/accel/random_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace testing;
using renderer::Budget;
using renderer::FaultList;
using renderer::Limits;
using renderer::MeshFacts;
using renderer::RenderSettings;
using renderer::SceneDescription;

namespace {

// Trees as they are where nothing else pays.
RenderSettings plain()
{
    RenderSettings settings;
    settings.acceleration.split = renderer::BvhSplit::sah;
    return settings;
}

constexpr std::uint32_t kTriangles = 1'000'000;

// A mesh whose parts lie within one another, each a triangle shorter than the one before; and "all", which is
// the whole, and "again", which is the second one.
MeshFacts nested()
{
    MeshFacts facts;
    facts.triangles = kTriangles;
    facts.vertices = kTriangles / 2;
    for (std::uint32_t depth = 1; depth <= 256; ++depth)
        facts.parts["part" + std::to_string(depth)] = {depth, kTriangles - depth, {}};
    facts.parts["all"] = {0, kTriangles, {}};
    facts.parts["again"] = {1, kTriangles - 1, {}};
    return facts;
}

SceneDescription scene_of(const std::vector<std::string>& parts)
{
    SceneDescription scene;
    scene.meshes.push_back({"nested.glb", ""});
    for (const std::string& part : parts)
        scene.objects.emplace_back().shape = renderer::MeshShape{0, part};
    return scene;
}

std::uint64_t mesh_bytes(const std::vector<std::string>& parts)
{
    return predict(scene_of(parts), std::vector{nested()}, plain()).mesh_bytes;
}

} // namespace

TEST(Budget, CountsATreeForEveryDifferentPart)
{
    const std::uint64_t whole = mesh_bytes({""}), one = mesh_bytes({"part1"}),
                        two = mesh_bytes({"part1", "part2"});
    EXPECT_EQ(one, whole + renderer::tree_bytes(kTriangles - 1));
    EXPECT_GT(two, one + renderer::tree_bytes(kTriangles - 2));
}

TEST(Budget, CountsOneTreeForPartsOfTheSameTriangles)
{
    const std::uint64_t object = mesh_bytes({"", ""}) - mesh_bytes({""});
    EXPECT_EQ(mesh_bytes({"part1", "again", "part1"}), mesh_bytes({"part1"}) + 2 * object);
    EXPECT_EQ(mesh_bytes({"all", ""}), mesh_bytes({"", ""}));
}

TEST(Budget, RefusesMorePartsThanMemoryHolds)
{
    std::vector<std::string> parts;
    for (int depth = 1; depth <= 256; ++depth)
        parts.push_back("part" + std::to_string(depth));
    FaultList faults;
    check_budget(predict(scene_of(parts), std::vector{nested()}, plain()), Limits{}, faults);
    const auto found = faults.take();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].pointer, "/scene/objects");
    EXPECT_THAT(found[0].detail, HasSubstr("render_memory_bytes"));
}

TEST(Budget, RefusesMoreTrianglesWithoutATreeThanStopsInTime)
{
    MeshFacts large = nested();
    large.triangles = Limits{}.listed_triangles / 2 + 1;
    const std::vector<MeshFacts> meshes{large};
    RenderSettings settings;
    const auto faults = [&](const SceneDescription& scene, Limits limits = {}) {
        FaultList found;
        limits.render_memory_bytes = Limits::none().render_memory_bytes;
        check_budget(predict(scene, meshes, settings), limits, found);
        return found.take();
    };
    EXPECT_TRUE(faults(scene_of({"", ""})).empty()) << "with trees";
    settings.acceleration.levels = renderer::BvhLevels::none;
    EXPECT_TRUE(faults(scene_of({""})).empty());
    EXPECT_TRUE(faults(scene_of({"", "part1"})).empty());
    const auto found = faults(scene_of({"", ""})); // instances count
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].pointer, "/acceleration/bvh/levels");
    EXPECT_EQ(found[0].code, "over_limit");
    EXPECT_THAT(found[0].detail, HasSubstr("16000002"));
    EXPECT_THAT(found[0].detail, HasSubstr("listed_triangles"));
    EXPECT_TRUE(faults(scene_of({"", ""}), Limits::none()).empty());
}

TEST(Budget, GrowsByOneMeshAtATimeToThatOfAll)
{
    const SceneDescription scene = scene_of({""});
    const std::vector<MeshFacts> meshes{nested(), nested()};
    Budget budget = predict(scene, {}, plain());
    for (const MeshFacts& mesh : meshes)
        add_mesh(budget, mesh, {true, true, true}, renderer::MeshTree::wide_sah);
    const Budget all = predict(scene, meshes, plain());
    EXPECT_EQ(budget.triangles, all.triangles);
    EXPECT_EQ(budget.mesh_bytes, all.mesh_bytes);
    EXPECT_EQ(budget.film_bytes, all.film_bytes);
}

TEST(Budget, CountsOfASharedMeshAllAndOfAnotherWhatIsAskedFor)
{
    SceneDescription scene = scene_of({""});
    scene.objects[0].shading = renderer::Shading::flat;
    MeshFacts facts = nested();
    const std::uint64_t bare = predict(scene, std::vector{facts}, plain()).mesh_bytes;
    facts.has_normals = facts.has_uvs = true;
    EXPECT_EQ(predict(scene, std::vector{facts}, plain()).mesh_bytes, bare);
    facts.is_shared = true;
    EXPECT_EQ(predict(scene, std::vector{facts}, plain()).mesh_bytes, bare + facts.vertices * 20);
}

TEST(Budget, CountsWhatTheLargestTreeTakesToBuildOnce)
{
    const SceneDescription scene = scene_of({""});
    MeshFacts small = nested();
    small.triangles = 1000;
    const Budget budget = predict(scene, std::vector{small, nested(), small}, plain());
    EXPECT_EQ(budget.building_bytes, renderer::tree_building_bytes(kTriangles));
}

TEST(Budget, CountsTheMostThatASpatialTreeMayHold)
{
    const SceneDescription scene = scene_of({""});
    const std::vector<MeshFacts> mesh{nested()};
    RenderSettings settings = plain();
    const Budget small = predict(scene, mesh, settings);
    settings.acceleration.split = renderer::BvhSplit::spatial;
    const Budget large = predict(scene, mesh, settings);
    const auto more = static_cast<std::uint64_t>(0.3 * static_cast<double>(renderer::tree_bytes(kTriangles)));
    EXPECT_EQ(large.mesh_bytes, small.mesh_bytes + more);
    EXPECT_GT(large.building_bytes, small.building_bytes);
}

TEST(Budget, RefusesATreeThatCouldNotBeBuilt)
{
    Limits limits;
    // Mesh, tree and picture would fit, building the tree does not.
    limits.render_memory_bytes = 800'000'000;
    renderer::RenderSettings settings;
    settings.image.width_px = settings.image.height_px = 16;
    MeshFacts facts;
    facts.triangles = 10 * kTriangles;
    FaultList faults;
    const Budget budget = predict(scene_of({""}), std::vector{facts}, settings);
    ASSERT_LT(budget.mesh_bytes + budget.film_bytes, limits.render_memory_bytes);
    check_budget(budget, limits, faults);
    const auto found = faults.take();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].pointer, "/scene/objects");
    EXPECT_THAT(found[0].detail,
                StartsWith(std::to_string(budget.mesh_bytes + budget.building_bytes) + " bytes of memory"));
}

// The estimate is held against trees of several kinds.
TEST(Budget, KnowsWithinATenthWhatTreesHold)
{
    renderer::random_scenes::Random random(1);
    renderer::ThreadPool pool(1);
    for (const renderer::Mesh& mesh :
         {renderer::random_scenes::grid(150, 1),
          renderer::random_scenes::closed_sphere(random, {0, 0, 0}, 1, 1.01, 150, 150),
          renderer::random_scenes::soup(random, 45000, 1, 0.3)}) {
        const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
        const auto tree = renderer::MeshBvh::build(mesh, {0, count}, renderer::BvhSplit::sah, pool);
        const double ratio =
            static_cast<double>(renderer::tree_bytes(count)) / static_cast<double>(tree->size_bytes());
        EXPECT_GT(ratio, 0.9);
        EXPECT_LT(ratio, 1.1);
    }
}

TEST(Budget, CountsTheLayersThatAreAskedFor)
{
    RenderSettings settings;
    settings.image.width_px = settings.image.height_px = 100;
    const std::uint64_t without = predict(scene_of({}), {}, settings).film_bytes;
    const auto with = [&](const renderer::LayerSet& layers) {
        settings.image.layers = layers;
        return predict(scene_of({}), {}, settings).film_bytes - without;
    };
    // Their sums; and their means where those are more than the picture's sums, which are gone by then.
    const auto want = [](const renderer::LayerSet& layers) {
        const std::uint64_t means = renderer::layer_image_bytes(layers), sums = sizeof(renderer::RgbSum);
        return 100 * 100 * (renderer::layer_sum_bytes(layers) + std::max(means, sums) - sums);
    };
    renderer::LayerSet all;
    for (const renderer::LayerEntry& entry : renderer::kLayers) {
        renderer::LayerSet one;
        one.add(entry.layer);
        all.add(entry.layer);
        EXPECT_EQ(with(one), want(one)) << entry.name;
    }
    EXPECT_EQ(with(all), want(all));
    EXPECT_GT(want(all), 100u * 100 * renderer::layer_sum_bytes(all));
}

TEST(Budget, CountsWhatShinesOfMeshesAndShapes)
{
    MeshFacts lamp = nested();
    lamp.shining_triangles = 1000;
    const auto bytes = [&](const SceneDescription& scene) {
        return predict(scene, std::vector{lamp}, plain()).mesh_bytes;
    };
    const std::uint64_t dark = mesh_bytes({""}), one = bytes(scene_of({""})) - dark;
    EXPECT_GT(one, 1000u * 400);
    EXPECT_EQ(bytes(scene_of({"", ""})) - mesh_bytes({"", ""}), 2 * one) << "each instance has its own";
    SceneDescription scene = scene_of({""});
    scene.materials = {{"lamp", renderer::EmitterMaterial{}}, {"clay", renderer::DiffuseMaterial{}}};
    scene.objects[0].material = 1;
    EXPECT_EQ(bytes(scene), dark);
    scene.objects[0].material = 0;
    EXPECT_EQ(bytes(scene) - dark, one * kTriangles / 1000) << "all of the mesh";
    scene.objects[0].shape = renderer::SphereShape{1};
    const std::uint64_t shining = bytes(scene);
    scene.objects[0].material = 1;
    EXPECT_EQ(shining - bytes(scene), one / 1000);
}

// What the estimate of one stands for, held against the sizes of what is made of many.
TEST(Budget, KnowsWithinATenthWhatLightsHold)
{
    constexpr std::uint32_t kCount = 10000;
    renderer::SceneLights lights;
    const renderer::Mesh mesh = renderer::random_scenes::grid(100, 1);
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const renderer::Triangle& t = mesh.triangles[i];
        lights.emitters.push_back(
            renderer::triangle_emitter(
                mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]), {1, 1, 1}, false)
                .value());
        lights.emitter_of[i] = i;
    }
    lights.pick_by_tree();
    // A node of the map: its link, key and value, and what the allocator adds; a bucket.
    constexpr std::uint64_t kFoundAgain = 8 + 16 + 8 + 8;
    const std::uint64_t held = kCount * (sizeof(renderer::Emitter) + kFoundAgain) + lights.tree.size_bytes() +
                               kCount * (sizeof(renderer::LightBounds) + 4); // while the tree is built
    SceneDescription scene = scene_of({""});
    MeshFacts facts = nested();
    const std::uint64_t dark = predict(scene, std::vector{facts}, plain()).mesh_bytes;
    facts.shining_triangles = kCount;
    const double ratio = static_cast<double>(predict(scene, std::vector{facts}, plain()).mesh_bytes - dark) /
                         static_cast<double>(held);
    EXPECT_GT(ratio, 0.9);
    EXPECT_LT(ratio, 1.1);
}

TEST(Budget, IsWhatThePlanPredictsPicturesAndAll)
{
    const renderer::ImageFacts picture{4096, 2048, 4096 * 2048 * 12, false, true};
    const SceneDescription scene = scene_of({""});
    const std::vector meshes{nested()};
    const Budget with = predict(scene, meshes, {}, std::vector{picture}),
                 without = predict(scene, meshes, plain());
    EXPECT_GE(memory_bytes(with), memory_bytes(without) + picture.bytes);
    EXPECT_EQ(renderer::predict_cost(scene, {}, with, {}).memory_bytes, memory_bytes(with));
    Limits limits;
    limits.render_memory_bytes = memory_bytes(with);
    FaultList faults;
    check_budget(with, limits, faults);
    EXPECT_TRUE(faults.empty());
    --limits.render_memory_bytes;
    check_budget(with, limits, faults);
    EXPECT_FALSE(faults.empty());
}

TEST(Budget, CountsLevelsOfPicturesOnSurfacesAlone)
{
    constexpr std::uint64_t kPixels = 4096 * 2048;
    const std::vector pictures{renderer::ImageFacts{4096, 2048, kPixels * 12, false, true}};
    SceneDescription scene = scene_of({});
    scene.environment = renderer::ImageEnvironment{};
    const Budget around = predict(scene, {}, plain(), pictures);
    EXPECT_EQ(around.texture_bytes, kPixels * (12 + 12 + 4)); // decoded; radiance and running sums
    EXPECT_LT(around.building_bytes, kPixels);
    renderer::DiffuseMaterial painted;
    painted.color.texture = renderer::TextureUse{};
    scene.environment.reset();
    scene.materials = {{"painted", painted}};
    const Budget on_surfaces = predict(scene, {}, plain(), pictures);
    EXPECT_EQ(on_surfaces.texture_bytes, kPixels * (12 + 4));
    EXPECT_EQ(on_surfaces.building_bytes, kPixels * 20); // a level and the next, as numbers
}
