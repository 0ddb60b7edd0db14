// A scene that is scaled, its lights' powers by the square, looks the same.
#include "tests/renderer/metamorphic/test_scenes.h"

using namespace renderer;
using namespace renderer::metamorphic;

namespace {

enum class By { transforms, files };

Rgb brighter(Rgb c, double by)
{
    return c * static_cast<float>(by);
}

TestScene scaled(double by, By how)
{
    TestScene test = home();
    SceneDescription& d = test.description;
    d.camera->position = d.camera->position * by;
    d.camera->aim = d.camera->aim * by;
    for (ObjectDescription& object : d.objects) {
        object.world_from_object.translation = object.world_from_object.translation * by;
        if (how == By::transforms) {
            object.world_from_object = object.world_from_object * Affine3::scale({by, by, by});
        } else if (auto* const box = std::get_if<BoxShape>(&object.shape)) {
            box->size_m = box->size_m * by;
        } else if (auto* const sphere = std::get_if<SphereShape>(&object.shape)) {
            sphere->radius_m *= by;
        } else if (auto* const disk = std::get_if<DiskShape>(&object.shape)) {
            disk->radius_m *= by;
        } else if (auto* const rectangle = std::get_if<RectangleShape>(&object.shape)) {
            rectangle->width_m *= by;
            rectangle->height_m *= by;
        }
    }
    if (how == By::files) test.meshes[0] = twisted_column().framed({}, by);
    auto& point = std::get<PointLight>(d.lights[0]);
    point.position = point.position * by;
    point.intensity = brighter(point.intensity, by * by);
    auto& spot = std::get<SpotLight>(d.lights[1]);
    spot.position = spot.position * by;
    spot.intensity = brighter(spot.intensity, by * by);
    return test;
}

} // namespace

// 2^56 times 5 m: a galaxy's 4e17.
TEST(ScaledScene, HasTheSameBytesForPowersOfTwo)
{
    const std::uint64_t want = digest(render_description(home()).film);
    for (const double by : {0x1p-20, 0x1p-50, 0x1p20, 0x1p-1, 0x1p3, 0x1p41, 0x1p55})
        for (const By how : {By::transforms, By::files})
            EXPECT_EQ(digest(render_description(scaled(by, how)).film), want)
                << by << " " << static_cast<int>(how);
}

TEST(ScaledScene, LooksTheSameForOthers)
{
    const LinearImage want = render_description(home()).film.mean();
    for (const double by : {1e-6, 1e-3, 0.3, 70.0, 1e3, 1e6})
        for (const By how : {By::transforms, By::files}) {
            const LinearImage image = render_description(scaled(by, how)).film.mean();
            EXPECT_EQ(different_pixels(image, want, 1e-5), 0u) << by << " " << static_cast<int>(how);
        }
}
