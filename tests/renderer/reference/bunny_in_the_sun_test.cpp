// A sunlit bunny against converged pictures of Cycles; with the one by direct light POV-Ray agrees to 0.00047 RMSE.
#include "renderer/io/import_mesh.h"
#include "tests/support/picture_error.h"
#include "tests/support/places.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

using namespace renderer;

namespace {

const std::string kShared = tests::source_dir() + "/../shared/";

std::optional<Mesh> import_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.empty()) return std::nullopt;
    const auto none = [](std::string_view) -> std::optional<std::span<const std::byte>> {
        return std::nullopt;
    };
    auto imported = import_mesh(path, std::as_bytes(std::span(text)), none, Limits{});
    if (std::holds_alternative<ImportFault>(imported)) return std::nullopt;
    return std::move(std::get<ImportedMesh>(imported).mesh);
}

// As reference/renders/README.md describes it.
tests::TestScene bunny_on_the_ground(Mesh bunny)
{
    tests::TestScene test;
    const Bounds3f box = bunny.bounds();
    const Vec3d lower = to_double(box.lower), upper = to_double(box.upper), center = (lower + upper) / 2.0;
    const double scale = 2 / length(upper - lower);
    test.meshes.push_back(std::move(bunny));

    SceneDescription& d = test.description;
    d.materials = {{"bunny", DiffuseMaterial{{0.6f, 0.5f, 0.4f}}},
                   {"ground", DiffuseMaterial{{0.4f, 0.4f, 0.4f}}}};
    ObjectDescription& object = d.objects.emplace_back();
    object.shape = MeshShape{};
    object.material = 0;
    object.shading = Shading::flat;
    object.world_from_object =
        Affine3::scale({scale, scale, scale}) * Affine3::translate({-center.x, -lower.y, -center.z});
    ObjectDescription& ground = d.objects.emplace_back();
    ground.shape = RectangleShape{100, 100};
    ground.material = 1;
    ground.world_from_object = Affine3::rotate_deg(-90, {1, 0, 0});
    d.lights.emplace_back(DirectionalLight{{-0.5, -1, -0.6}, {3, 3, 3}});
    d.camera.emplace();
    d.camera->position = {0.9, 1.3, 2.8};
    d.camera->aim = {0, 0.6, 0};
    d.camera->fov_deg = 40;
    d.transport.type = TransportType::direct;
    test.settings.image.width_px = test.settings.image.height_px = 512;
    return test;
}

} // namespace

TEST(Reference, BunnyInHardSunLooksAsInCycles)
{
    const auto reference = tests::read_pfm(kShared + "reference/renders/bunny_hard_direct.pfm");
    std::optional<Mesh> bunny = import_file(kShared + "assets/bunny.obj");
    if (!reference || !bunny) GTEST_SKIP() << "../shared with its reference pictures is not here";
    tests::TestScene test = bunny_on_the_ground(std::move(*bunny));
    test.settings.quality.samples = 16;
    const LinearImage image = tests::render_description(test).film.mean();

    // Cycles itself is 0.0116 off at 16 samples, POV-Ray 0.0123 at its comparable setting.
    tests::expect_looks_as("bunny_hard_direct", image, *reference, 0.0116, 5e-5);
}

TEST(Reference, BunnyInSoftSunByPathsLooksAsInCycles)
{
    const auto reference = tests::read_pfm(kShared + "reference/renders/bunny_sun_path.pfm");
    std::optional<Mesh> bunny = import_file(kShared + "assets/bunny.obj");
    if (!reference || !bunny) GTEST_SKIP() << "../shared with its reference pictures is not here";
    tests::TestScene test = bunny_on_the_ground(std::move(*bunny));
    test.description.lights = {SunLight{{-0.5, -1, -0.6}, {3, 3, 3}, 0.526 / 2}};
    test.description.transport.type = TransportType::path;
    test.description.transport.max_depth = 9; // that many hits
    test.settings.quality.samples = 4;
    const LinearImage image = tests::render_description(test).film.mean();

    // Cycles itself is 0.0755 off at 4 samples; a pixel's noise is a sixteenth in a square's mean.
    tests::expect_looks_as("bunny_sun_path", image, *reference, 0.0755, 5e-4);
    EXPECT_LT(tests::relative_rmse(tests::in_squares(image, 16), tests::in_squares(*reference, 16)),
              0.0755 / 16);
}
