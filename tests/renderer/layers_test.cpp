// Layers beside a picture, from the front door: the same bits whatever computes them, averages as the picture's.
#include "tests/support/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace renderer;
using tests::digest;
using tests::kitchen_sink;
using tests::render_description;
using tests::TestScene;

namespace {

LayerSet every_layer()
{
    LayerSet all;
    for (const LayerEntry& entry : kLayers)
        all.add(entry.layer);
    return all;
}

TestScene layered()
{
    TestScene test = kitchen_sink();
    test.settings.image.layers = every_layer();
    return test;
}

} // namespace

TEST(Layers, HaveTheSameBitsOnAnyThreadsAndTiles)
{
    const Film want = render_description(layered(), 1).film;
    for (const unsigned threads : {2u, 5u, 16u})
        EXPECT_TRUE(render_description(layered(), threads).film.layers == want.layers) << threads;
    for (const std::uint32_t tile : {1u, 7u, 64u, 1000000u}) {
        TestScene test = layered();
        test.settings.acceleration.tile_px = tile;
        EXPECT_TRUE(render_description(test, 2).film.layers == want.layers) << tile;
    }
}

TEST(Layers, LeaveThePictureAsItIs)
{
    EXPECT_EQ(digest(render_description(layered()).film), digest(render_description(kitchen_sink()).film));
    EXPECT_TRUE(render_description(kitchen_sink()).film.layers.mean(1).empty());
    // What one layer holds does not depend on which others are asked for.
    const Film all = render_description(layered()).film;
    for (const LayerEntry& entry : kLayers) {
        TestScene test = kitchen_sink();
        test.settings.image.layers.add(entry.layer);
        const Film one = render_description(test).film;
        const auto images = one.layers.mean(one.samples);
        ASSERT_EQ(images.size(), 1u);
        EXPECT_EQ(images[0].values,
                  all.layers.mean(all.samples)[static_cast<std::size_t>(entry.layer)].values);
    }
}

TEST(Layers, OfACropAreThoseOfTheFullPicture)
{
    TestScene test = layered();
    const Film full = render_description(test).film;
    const auto whole = full.layers.mean(full.samples);
    const PixelRect region{13, 9, 30, 20};
    test.settings.image.region = region;
    const Film crop = render_description(test).film;
    const auto part = crop.layers.mean(crop.samples);
    for (std::size_t l = 0; l < part.size(); ++l) {
        const std::size_t channels = entry_of(part[l].layer).channel_count();
        for (std::uint32_t y = 0; y < region.height; ++y)
            for (std::uint32_t x = 0; x < region.width; ++x)
                for (std::size_t c = 0; c < channels; ++c)
                    ASSERT_EQ(part[l].values[(y * region.width + x) * channels + c],
                              whole[l].values[((region.y + y) * 70 + region.x + x) * channels + c]);
    }
}

TEST(Layers, AverageOverAPixelAsThePictureDoes)
{
    // A white wall that shines upon nobody, under light from everywhere, before nothing: the picture is the share of
    // each pixel that the wall covers, and so is what its layers hold of it.
    TestScene test;
    SceneDescription& d = test.description;
    d.materials = {{"white", DiffuseMaterial{{1, 1, 1}}}};
    ObjectDescription& wall = d.objects.emplace_back();
    wall.shape = RectangleShape{1.3, 0.9};
    wall.material = 0;
    wall.world_from_object = Affine3::rotate_deg(20, {0, 0, 1});
    CameraDescription camera;
    camera.projection = Projection::orthographic;
    camera.position = {0, 0, 4};
    camera.height_m = 2;
    d.camera = camera;
    d.lights.emplace_back(DirectionalLight{{0, 0, -1}, {3, 3, 3}});
    d.environment = NoEnvironment{};
    test.settings.image.width_px = test.settings.image.height_px = 20;
    test.settings.image.layers = every_layer();
    test.settings.quality.samples = 32;
    const Film film = render_description(test).film;
    const LinearImage picture = film.mean();
    const auto layers = film.layers.mean(film.samples);
    const float full = picture.pixels[10 * 20 + 10].g;
    std::size_t edges = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const float share = picture.pixels[i].g / full;
        if (share > 0 && share < 1) ++edges;
        EXPECT_NEAR(layers[2].values[3 * i + 1], share, 1e-6);
        EXPECT_NEAR(layers[1].values[3 * i + 2], share, 1e-6);
        EXPECT_NEAR(layers[1].values[3 * i], 0, 1e-6);
        if (share > 0)
            EXPECT_NEAR(layers[0].values[i], 4, 1e-6); // whatever share of it
        else
            EXPECT_TRUE(std::isinf(layers[0].values[i]));
        EXPECT_EQ(layers[3].values[i], 32);
    }
    EXPECT_GT(edges, 20u);
}

TEST(Layers, AreToldInThePlan)
{
    const auto told = [](const TestScene& test) {
        std::string why;
        for (const ModelChoice& choice : render_description(test).report.models.used)
            if (choice.name == "layers") why = choice.why;
        return why;
    };
    EXPECT_EQ(told(kitchen_sink()), "");
    EXPECT_EQ(told(layered()).substr(0, 30), "depth, normal, albedo, samples");
}
