// A box lit by a lamp and by what its walls send on, against a converged picture of Cycles.
#include "tests/support/picture_error.h"
#include "tests/support/places.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <string>

using namespace renderer;

namespace {

ObjectDescription object(Shape shape, std::uint32_t material, const Affine3& world_from_object)
{
    ObjectDescription o;
    o.shape = std::move(shape);
    o.material = material;
    o.world_from_object = world_from_object;
    return o;
}

// As reference/renders/README.md describes it.
tests::TestScene cornell_box()
{
    tests::TestScene test;
    SceneDescription& d = test.description;
    d.materials = {{"white", DiffuseMaterial{{0.73f, 0.73f, 0.73f}}},
                   {"red", DiffuseMaterial{{0.65f, 0.05f, 0.05f}}},
                   {"green", DiffuseMaterial{{0.12f, 0.45f, 0.15f}}}};
    const auto turn = [](double degrees, Vec3d axis) { return Affine3::rotate_deg(degrees, axis); };
    const auto move = [](double x, double y, double z) { return Affine3::translate({x, y, z}); };
    const RectangleShape wall{2, 2};
    const auto block = [&](double height, double degrees, double x, double z) {
        return object(BoxShape{{0.6, height, 0.6}}, 0, move(x, height / 2, z) * turn(degrees, {0, 1, 0}));
    };
    d.objects = {object(wall, 0, turn(-90, {1, 0, 0})),
                 object(wall, 0, move(0, 2, 0) * turn(90, {1, 0, 0})),
                 object(wall, 0, move(0, 1, -1)),
                 object(wall, 1, move(-1, 1, 0) * turn(90, {0, 1, 0})),
                 object(wall, 2, move(1, 1, 0) * turn(-90, {0, 1, 0})),
                 block(0.6, -18, 0.33, 0.37),
                 block(1.2, 17, -0.33, -0.28)};
    RectangleLight lamp;
    lamp.radiance = {17, 17, 17};
    lamp.width_m = 0.5;
    lamp.height_m = 0.4;
    lamp.world_from_light = move(0, 1.98, 0) * turn(90, {1, 0, 0});
    d.lights.emplace_back(lamp);
    d.environment = NoEnvironment{};
    d.camera.emplace();
    d.camera->position = {0, 1, 3.9};
    d.camera->aim = {0, 1, 0};
    d.camera->fov_deg = 39;
    d.transport.type = TransportType::path;
    d.transport.max_depth = 9; // that many hits
    test.settings.image.width_px = test.settings.image.height_px = 512;
    return test;
}

} // namespace

TEST(Reference, CornellBoxByPathsLooksAsInCycles)
{
    const auto reference =
        tests::read_pfm(tests::source_dir() + "/../shared/reference/renders/cornell_path.pfm");
    if (!reference) GTEST_SKIP() << "../shared with its reference pictures is not here";
    tests::TestScene test = cornell_box();
    test.settings.quality.samples = 4;
    const LinearImage image = tests::render_description(test).film.mean();

    // Cycles itself is 0.414 off at 4 samples; a pixel's noise is a sixteenth in a square's mean.
    tests::expect_looks_as("cornell_path", image, *reference, 0.414, 3e-3);
    EXPECT_LT(tests::relative_rmse(tests::in_squares(image, 16), tests::in_squares(*reference, 16)),
              0.414 / 16);
}
