#include "renderer/plan/joined_objects.h"

#include <gtest/gtest.h>

using namespace renderer;

namespace {

MeshFacts facts_of_size(std::uint64_t triangles)
{
    MeshFacts facts;
    facts.bounds = {{-1, -1, -1}, {1, 1, 1}};
    facts.triangles = triangles;
    return facts;
}

ObjectDescription object(const Shape& shape, Vec3d at = {})
{
    ObjectDescription made;
    made.shape = shape;
    made.world_from_object = Affine3::translate(at);
    return made;
}

std::vector<bool> chosen(const std::vector<ObjectDescription>& objects,
                         const std::vector<MeshFacts>& meshes = {},
                         Vec3d world_origin = {})
{
    SceneDescription scene;
    scene.objects = objects;
    return choose_joined(scene, meshes, world_origin).objects;
}

} // namespace

TEST(JoinedObjects, AreTwoAtLeastAndOfTriangles)
{
    EXPECT_EQ(chosen({object(BoxShape{})}), std::vector<bool>({false}));
    EXPECT_EQ(chosen({object(BoxShape{}), object(SphereShape{})}), std::vector<bool>({false, false}));
    EXPECT_EQ(chosen({object(BoxShape{}), object(SphereShape{}), object(RectangleShape{})}),
              std::vector<bool>({true, false, true}));
}

TEST(JoinedObjects, AreSmallInAllTheirPlacesTogether)
{
    const std::vector<MeshFacts> meshes{facts_of_size(4096), facts_of_size(4097), facts_of_size(2049)};
    const auto mesh = [](std::uint32_t number) { return object(MeshShape{number, {}}); };
    EXPECT_EQ(chosen({mesh(0), mesh(1), mesh(2)}, meshes), std::vector<bool>({true, false, true}));
    EXPECT_EQ(chosen({mesh(0), mesh(2), mesh(2), object(BoxShape{})}, meshes),
              std::vector<bool>({true, false, false, true}));
}

TEST(JoinedObjects, AreNoneWhereTheyAreTooManyInAll)
{
    const auto joined = [](std::uint32_t count) {
        std::vector<MeshFacts> meshes(count, facts_of_size(4096));
        std::vector<ObjectDescription> objects;
        for (std::uint32_t i = 0; i < count; ++i)
            objects.push_back(object(MeshShape{i, {}}));
        SceneDescription scene;
        scene.objects = objects;
        return choose_joined(scene, meshes, {}).count;
    };
    EXPECT_EQ(joined(16), 16u);
    EXPECT_EQ(joined(17), 0u);
}

TEST(JoinedObjects, LeaveOutWhatFloatsOfTheFrameWouldBeCoarseFor)
{
    const auto at = [](double x) { return object(BoxShape{{1, 1, 1}}, {x, 0, 0}); };
    EXPECT_EQ(chosen({at(0), at(5000), at(10000)}), std::vector<bool>({false, false, false}));
    EXPECT_EQ(chosen({at(0), at(4000)}), std::vector<bool>({true, true}));
    // It is the frame that counts.
    EXPECT_EQ(chosen({at(1e9), at(1e9 + 4000)}, {}, {1e9, 0, 0}), std::vector<bool>({true, true}));
}

TEST(JoinedObjects, LeaveOutWhatACameraDoesNotSeeAndCornersThatAreMoreThanFloats)
{
    ObjectDescription hidden = object(BoxShape{});
    hidden.visible_to_camera = false;
    EXPECT_EQ(chosen({object(BoxShape{}), hidden, object(BoxShape{})}),
              std::vector<bool>({true, false, true}));
    MeshFacts exact = facts_of_size(12);
    exact.has_residuals = true;
    EXPECT_EQ(chosen({object(BoxShape{}), object(MeshShape{0, {}}), object(BoxShape{})}, {exact}),
              std::vector<bool>({true, false, true}));
}

TEST(JoinedObjects, CountLightsThatAreRectangles)
{
    SceneDescription scene;
    scene.objects = {object(BoxShape{})};
    scene.lights.emplace_back(PointLight{});
    scene.lights.emplace_back(RectangleLight{});
    scene.lights.emplace_back(SphereLight{});
    const JoinedObjects joined = choose_joined(scene, {}, {});
    EXPECT_EQ(joined.objects, std::vector<bool>({true}));
    EXPECT_EQ(joined.lights, std::vector<bool>({false, true, false}));
    EXPECT_EQ(joined.count, 2u);
    EXPECT_EQ(joined.triangles, 14u);
    EXPECT_EQ(most_joined_triangles(scene, {}), 14u);
}
