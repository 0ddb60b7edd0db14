#include "renderer/plan/mesh_trees.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using namespace renderer;

// Paths of three scatterings, 100 x 100 pixels of 16 samples: 960,000 rays that run apart.
struct Question {
    SceneDescription scene;
    RenderSettings settings;

    Question()
    {
        scene.transport.type = TransportType::path;
        scene.environment = ColorEnvironment{};
        settings.image.width_px = settings.image.height_px = 100;
        settings.quality.samples = 16;
    }
    MeshTree tree(std::uint64_t triangles) const { return MeshTrees(scene, settings).of(triangles); }
};

} // namespace

TEST(MeshTrees, AreBuiltLongerWhereManyRaysWillRunApart)
{
    const Question question;
    EXPECT_EQ(question.tree(7500), MeshTree::wide_spatial);
    EXPECT_EQ(question.tree(7501), MeshTree::wide_sah);
}

TEST(MeshTrees, ArePlainWhereRaysRunAlike)
{
    Question question;
    question.scene.transport.type = TransportType::direct;
    EXPECT_EQ(question.tree(12), MeshTree::wide_sah);
    question.scene.transport.type = TransportType::normals;
    EXPECT_EQ(question.tree(12), MeshTree::wide_sah);
}

TEST(MeshTrees, AreThoseAskedFor)
{
    Question question;
    question.settings.acceleration.split = BvhSplit::sah;
    EXPECT_EQ(question.tree(12), MeshTree::wide_sah);
    question.settings.acceleration.split = BvhSplit::spatial;
    EXPECT_EQ(question.tree(1u << 30), MeshTree::wide_spatial);
    question.settings.acceleration.levels = BvhLevels::none;
    EXPECT_EQ(question.tree(12), MeshTree::none);
}

TEST(MeshTrees, MindTheTimeThatARenderHas)
{
    Question question;
    question.settings.quality.samples.reset();
    question.settings.quality.time_s = 0.01;
    question.settings.acceleration.threads = 1;
    EXPECT_EQ(question.tree(10000), MeshTree::wide_sah);
    question.settings.quality.time_s = 100;
    EXPECT_EQ(question.tree(10000), MeshTree::wide_spatial);
}

TEST(MeshTrees, AreTheSameBeforeAndAfterDefaultsAreFilledIn)
{
    Question question;
    question.scene = SceneDescription();
    const AssumedScene assumed = assume_defaults(question.scene, {}, 1);
    for (const std::uint64_t triangles : {100u, 10000u, 100000u})
        EXPECT_EQ(question.tree(triangles), MeshTrees(assumed.description, question.settings).of(triangles));
}

TEST(MeshTrees, ArePlainInADescriptionThatNamesWhatIsNotThere)
{
    Question question;
    question.scene.objects.emplace_back().material = 3;
    EXPECT_EQ(question.tree(12), MeshTree::wide_sah);
    question.scene.objects.back().material.reset();
    question.scene.objects.back().shape = MeshShape{7, ""};
    EXPECT_EQ(question.tree(12), MeshTree::wide_sah);
}

TEST(MeshTrees, SayWhy)
{
    const Question question;
    MeshFacts small, large;
    small.triangles = 100;
    large.triangles = 1'000'000;
    ModelReport report;
    MeshTrees(question.scene, question.settings).explain(std::vector{small, large}, report);
    ASSERT_EQ(report.used.size(), 1u);
    EXPECT_EQ(report.used[0].name, "spatial_splits");
    EXPECT_THAT(report.used[0].why, testing::HasSubstr("1 of the meshes: about 9.6e+05 rays"));
    ModelReport none;
    MeshTrees(question.scene, question.settings).explain(std::vector{large}, none);
    ASSERT_EQ(none.skipped.size(), 1u);
}
