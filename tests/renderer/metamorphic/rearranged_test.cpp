// A scene that is turned, taken apart or told in another order looks the same.
#include "tests/renderer/metamorphic/test_scenes.h"

using namespace renderer;
using namespace renderer::metamorphic;

namespace {

TestScene turned(const Affine3& turn, bool with_sky)
{
    TestScene test = home(with_sky);
    SceneDescription& d = test.description;
    d.camera->position = turn.vector(d.camera->position);
    d.camera->aim = turn.vector(d.camera->aim);
    d.camera->up = turn.vector(d.camera->up);
    for (ObjectDescription& object : d.objects)
        object.world_from_object = turn * object.world_from_object;
    auto& point = std::get<PointLight>(d.lights[0]);
    point.position = turn.vector(point.position);
    auto& spot = std::get<SpotLight>(d.lights[1]);
    spot.position = turn.vector(spot.position);
    spot.direction = turn.vector(spot.direction);
    auto& directional = std::get<DirectionalLight>(d.lights[2]);
    directional.direction = turn.vector(directional.direction);
    return test;
}

// Three runs of the column's triangles.
std::vector<MeshPart> thirds()
{
    const auto count = static_cast<std::uint32_t>(twisted_column().triangles.size());
    return {{"low", 0, count / 3},
            {"middle", count / 3, count / 2 - count / 3},
            {"high", count / 2, count - count / 2}};
}

} // namespace

TEST(RearrangedScene, LooksTheSameTurnedByRightAngles)
{
    const LinearImage want = render_description(home(false)).film.mean();
    const LinearImage want_with_sky = render_description(home()).film.mean();
    for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        for (const double degrees : {90.0, 180.0, 270.0}) {
            const Affine3 turn = Affine3::rotate_deg(degrees, axis);
            const LinearImage image = render_description(turned(turn, false)).film.mean();
            EXPECT_LE(different_pixels(image, want, 1e-5), 1u) << degrees;
            // Directions towards the sky are drawn in a frame of the surface's own, which turns otherwise.
            const LinearImage with_sky = render_description(turned(turn, true)).film.mean();
            EXPECT_NEAR(tests::mean_of(with_sky).g, tests::mean_of(want_with_sky).g, 0.01f) << degrees;
        }
}

TEST(RearrangedScene, HasTheSameBytesInAnyOrderOfItsObjects)
{
    const std::uint64_t want = digest(render_description(home()).film);
    for (std::size_t first = 0; first < 5; ++first) {
        TestScene test = home();
        auto& objects = test.description.objects;
        std::rotate(objects.begin(), objects.begin() + static_cast<std::ptrdiff_t>(first), objects.end());
        EXPECT_EQ(digest(render_description(test).film), want) << first;
        std::reverse(objects.begin(), objects.end());
        EXPECT_EQ(digest(render_description(test).film), want) << first;
    }
}

TEST(RearrangedScene, HasTheSameBytesWithAMeshInParts)
{
    const std::uint64_t want = digest(render_description(home()).film);
    TestScene test = home();
    test.meshes[0].parts = thirds();
    auto& objects = test.description.objects;
    const ObjectDescription column = objects[0];
    objects.erase(objects.begin());
    for (const MeshPart& part : thirds()) {
        objects.push_back(column);
        objects.back().shape = MeshShape{0, part.name};
    }
    EXPECT_EQ(digest(render_description(test).film), want);
}

TEST(RearrangedScene, HasTheSameBytesWithAMeshInSeveralFiles)
{
    const std::uint64_t want = digest(render_description(home()).film);
    TestScene test = home();
    auto& objects = test.description.objects;
    const ObjectDescription column = objects[0];
    objects.erase(objects.begin());
    test.meshes.clear();
    for (const MeshPart& part : thirds()) {
        ExactMesh file = twisted_column();
        const auto first = file.triangles.begin() + part.first_triangle;
        file.triangles = {first, first + part.triangle_count};
        objects.push_back(column);
        objects.back().shape = MeshShape{static_cast<std::uint32_t>(test.meshes.size()), ""};
        test.meshes.push_back(file.framed());
    }
    EXPECT_EQ(digest(render_description(test).film), want);
}

TEST(RearrangedScene, HasTheSameBytesWithTrianglesInAnotherOrder)
{
    const std::uint64_t want = digest(render_description(home()).film);
    TestScene test = home();
    std::reverse(test.meshes[0].triangles.begin(), test.meshes[0].triangles.end());
    EXPECT_EQ(digest(render_description(test).film), want);
}

// Two surfaces in one place: the first object's, whatever the tree and the threads.
TEST(RearrangedScene, ShowsTheFirstOfTwoSurfacesInOnePlace)
{
    TestScene test = home();
    auto& objects = test.description.objects;
    const std::uint64_t want = digest(render_description(test).film);
    ObjectDescription again = objects[0];
    again.material = 1;
    objects.push_back(again);
    for (const BvhSplit split : {BvhSplit::sah, BvhSplit::midpoint, BvhSplit::spatial})
        for (const unsigned threads : {1u, 2u, 5u}) {
            test.settings.acceleration.split = split;
            EXPECT_EQ(digest(render_description(test, threads).film), want);
        }
}
