// Prints digests of rendered films: the same lines wherever and however it is run.
#include "tests/support/render_scene.h"

#include <cstdio>

int main()
{
    for (const unsigned threads : {1u, 2u, 5u})
        for (const std::uint32_t tile : {1u, 7u, 16u, 64u}) {
            tests::TestScene test = tests::kitchen_sink();
            test.settings.acceleration.tile_px = tile;
            const std::string line = tests::hex(tests::digest(tests::render_description(test, threads).film));
            std::printf("kitchen_sink %s\n", line.c_str());
        }
    // Shininess, angles and exponents of every size, so that every transcendental function is met widely.
    for (int i = 0; i < 40; ++i) {
        tests::TestScene test = tests::kitchen_sink();
        test.settings.image.width_px = test.settings.image.height_px = 24;
        test.settings.seed = static_cast<std::uint64_t>(i);
        for (renderer::NamedMaterial& named : test.description.materials)
            if (auto* const phong = std::get_if<renderer::PhongMaterial>(&named.material))
                phong->shininess = 0.3 * (i + 1) * (i + 1) * (i + 1);
        test.description.camera->fov_deg = 5 + 4 * i;
        for (renderer::ObjectDescription& object : test.description.objects)
            object.world_from_object =
                object.world_from_object * renderer::Affine3::rotate_deg(7.3 * i, {1, 0.3 * i, -2});
        const std::string line = tests::hex(tests::digest(tests::render_description(test).film));
        std::printf("variation %d %s\n", i, line.c_str());
    }
}
