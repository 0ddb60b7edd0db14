// What the metamorphic tests render: a mesh, shapes and lights whose every place is a multiple of 2^-20, and ways to
// compare two pictures.
#pragma once

#include "renderer/geometry/mesh_frame.h"
#include "renderer/math/transcendental.h"
#include "tests/support/picture_error.h"
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace renderer::metamorphic {

using tests::digest;
using tests::render_description;
using tests::TestScene;

// A twisted box of 8 x 8 quads a side in multiples of 2^-20, as a file in double would have it.
struct ExactMesh {
    std::vector<Vec3d> places;
    std::vector<Triangle> triangles;

    Mesh framed(Vec3d moved_by = {}, double scale = 1) const
    {
        Mesh mesh;
        mesh.triangles = triangles;
        std::vector<Vec3d> in_file = places;
        for (Vec3d& p : in_file)
            p = p * scale + moved_by;
        set_positions(mesh, in_file);
        return mesh;
    }
};

inline ExactMesh twisted_column()
{
    ExactMesh mesh;
    constexpr std::uint32_t kRings = 8, kSides = 6;
    const auto exact = [](double x) { return std::floor(x * 0x1p20) * 0x1p-20; };
    for (std::uint32_t i = 0; i <= kRings; ++i)
        for (std::uint32_t j = 0; j < kSides; ++j) {
            const double turn = 2 * kPi * j / kSides + 0.2 * i, r = 0.8 + 0.3 * std::sin(0.9 * i);
            mesh.places.push_back(
                {exact(r * std::cos(turn)), exact(0.25 * i - 1), exact(r * std::sin(turn))});
        }
    for (std::uint32_t i = 0; i < kRings; ++i)
        for (std::uint32_t j = 0; j < kSides; ++j) {
            const std::uint32_t a = i * kSides + j, b = i * kSides + (j + 1) % kSides;
            mesh.triangles.push_back({a, a + kSides, b + kSides});
            mesh.triangles.push_back({a, b + kSides, b});
        }
    return mesh;
}

// The column, a box, a sphere, a disk and a floor, two lights of three kinds and a sky.
inline TestScene home(bool with_sky = true)
{
    TestScene test;
    SceneDescription& d = test.description;
    d.transport.type = TransportType::direct;
    test.meshes.push_back(twisted_column().framed());
    PhongMaterial shiny;
    shiny.diffuse = {0.3f, 0.4f, 0.5f};
    shiny.specular = {0.3f, 0.3f, 0.3f};
    d.materials = {{"clay", DiffuseMaterial{{0.6f, 0.5f, 0.4f}}}, {"shiny", shiny}};
    const auto add = [&](Shape shape, std::uint32_t material, const Affine3& placed) {
        ObjectDescription& object = d.objects.emplace_back();
        object.shape = std::move(shape);
        object.material = material;
        object.world_from_object = placed;
    };
    add(MeshShape{}, 0, Affine3::translate({-1.25, 0, 0.5}));
    add(BoxShape{{1, 1.5, 0.75}},
        1,
        Affine3::translate({1.5, -0.25, 0}) * Affine3::rotate_deg(30, {0, 1, 0}));
    add(SphereShape{0.625}, 1, Affine3::translate({0.25, -0.375, 1.5}));
    add(DiskShape{0.5}, 0, Affine3::translate({0.25, 1.25, 0.5}) * Affine3::rotate_deg(-40, {1, 0.5, 0}));
    add(RectangleShape{16, 16}, 0, Affine3::translate({0, -1, 0}) * Affine3::rotate_deg(-90, {1, 0, 0}));
    d.camera.emplace();
    d.camera->position = {1.5, 1.75, 5.5};
    d.camera->aim = {0.125, 0, 0.25};
    d.camera->fov_deg = 40;
    d.environment = NoEnvironment{};
    if (with_sky) d.environment = ColorEnvironment{{0.2f, 0.25f, 0.3f}};
    d.lights.emplace_back(PointLight{{2.5, 3.5, 2}, {30, 28, 25}});
    d.lights.emplace_back(SpotLight{{-3, 4, 3}, {3, -4.5, -3}, {40, 40, 50}, 12, 20});
    d.lights.emplace_back(DirectionalLight{{0.3, -1, -0.2}, {0.5f, 0.5f, 0.4f}});
    test.settings.image.width_px = 72;
    test.settings.image.height_px = 54;
    test.settings.quality.samples = 4;
    return test;
}

// Pixels that differ by more than `tolerance` of the pictures' mean.
inline std::size_t different_pixels(const LinearImage& a, const LinearImage& b, double tolerance)
{
    const Rgb mean = tests::mean_of(a);
    const double unit = tolerance * static_cast<double>(mean.r + mean.g + mean.b) / 3;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgb p = a.pixels[i], q = b.pixels[i];
        const double off = std::max({std::abs(static_cast<double>(p.r) - static_cast<double>(q.r)),
                                     std::abs(static_cast<double>(p.g) - static_cast<double>(q.g)),
                                     std::abs(static_cast<double>(p.b) - static_cast<double>(q.b))});
        count += off > unit ? 1u : 0u;
    }
    return count;
}

} // namespace renderer::metamorphic
