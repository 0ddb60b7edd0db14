// A scene that is moved, its camera with it, looks the same.
#include "tests/renderer/metamorphic/test_scenes.h"

using namespace renderer;
using namespace renderer::metamorphic;

namespace {

enum class By { transforms, files };

// Everything moved: objects by their transforms, or meshes where their files have them.
TestScene moved(Vec3d by, By how)
{
    TestScene test = home();
    SceneDescription& d = test.description;
    d.camera->position = d.camera->position + by;
    d.camera->aim = d.camera->aim + by;
    for (ObjectDescription& object : d.objects)
        if (how == By::transforms || !std::holds_alternative<MeshShape>(object.shape))
            object.world_from_object.translation = object.world_from_object.translation + by;
    if (how == By::files) test.meshes[0] = twisted_column().framed(by);
    std::get<PointLight>(d.lights[0]).position = std::get<PointLight>(d.lights[0]).position + by;
    std::get<SpotLight>(d.lights[1]).position = std::get<SpotLight>(d.lights[1]).position + by;
    return test;
}

bool uses(const RenderReport& report, const std::string& name)
{
    return std::any_of(report.models.used.begin(), report.models.used.end(), [&](const ModelChoice& model) {
        return model.name == name;
    });
}

} // namespace

TEST(MovedScene, HasTheSameBytesWhereItsPlacesAreExact)
{
    const std::uint64_t want = digest(render_description(home()).film);
    for (const double step : {0x1p20, 0x1p23, 0x1p30})
        for (const Vec3d way : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{1, 1, -1}})
            for (const By how : {By::transforms, By::files}) {
                const RenderResult result = render_description(moved(way * step, how));
                EXPECT_EQ(digest(result.film), want) << step << " " << static_cast<int>(how);
                EXPECT_TRUE(uses(result.report, "recentred_scene"));
                EXPECT_EQ(uses(result.report, "recentred_meshes"), how == By::files);
                EXPECT_GT(result.report.numerics.coordinate_ratio, 1e4);
            }
}

TEST(MovedScene, LooksTheSameWhereItsPlacesRound)
{
    const LinearImage want = render_description(home()).film.mean();
    for (const double size : {1e6, 1e7, 1e9})
        for (const By how : {By::transforms, By::files}) {
            const Vec3d by = Vec3d{0.7123456789, -0.3987654321, 0.5555555555} * size;
            const LinearImage image = render_description(moved(by, how)).film.mean();
            // At 1e9 a place rounds by 1e-7, a millionth of a pixel: here and there a sample falls off an edge.
            EXPECT_LE(different_pixels(image, want, 1e-4), 4u) << size;
            EXPECT_LT(tests::relative_rmse(image, want), 0.01) << size;
        }
}

TEST(MovedScene, KeepsTheWorldsFrameAtHome)
{
    const RenderReport report = render_description(home()).report;
    EXPECT_FALSE(uses(report, "recentred_scene"));
    EXPECT_FALSE(uses(report, "recentred_meshes"));
    EXPECT_FALSE(uses(report, "double_corners"));
    EXPECT_TRUE(uses(report, "float_corners"));
    EXPECT_EQ(report.numerics.precision, "float");
}
