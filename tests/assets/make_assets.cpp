// heliograph-make-assets FOLDER: writes the meshes, textures and broken files that the tests use. Same bytes
// every time.
#include "tests/assets/broken_files.h"
#include "tests/assets/shapes.h"
#include "tests/assets/write_files.h"
#include "tests/assets/write_images.h"
#include "tests/assets/write_scenes.h"

#include <cstdio>
#include <exception>
#include <filesystem>

namespace {

using tests::Encoding;
using tests::write_file;

void write_knot(const std::filesystem::path& folder)
{
    const tests::AssetMesh knot = tests::make_knot(192, 16); // 6144 triangles
    write_file(folder / "knot.obj", "o knot\n" + obj_text(knot));
    write_file(folder / "knot.ply", ply_bytes(knot, Encoding::binary));
    write_file(folder / "knot_ascii.ply", ply_bytes(knot, Encoding::ascii));
    write_file(folder / "knot.stl", stl_bytes(knot, Encoding::binary));
    write_file(folder / "knot_ascii.stl", stl_bytes(knot, Encoding::ascii));
    write_file(folder / "knot.off", off_text(knot));
    write_file(folder / "knot.dae", collada_text(knot));
    write_file(folder / "knot.fbx", fbx_bytes(knot));
    write_file(folder / "knot_ascii.fbx", fbx_text(knot));
    write_file(folder / "knot.3ds", three_ds_bytes(knot));
    const std::vector<tests::GltfMesh> meshes{{knot, {0.7f, 0.35f, 0.15f}}};
    const std::vector<tests::GltfNode> nodes{{"knot", 0, {}, ""}};
    write_file(folder / "knot.glb", glb_bytes(gltf_text(meshes, nodes, {0}, "")));
    const tests::GltfText text = gltf_text(meshes, nodes, {0}, "knot.bin");
    write_file(folder / "knot.gltf", text.json);
    write_file(folder / "knot.bin", text.buffer);
}

void write_with_materials(const std::filesystem::path& folder)
{
    write_file(folder / "box.obj",
               "mtllib box.mtl\no box\nusemtl checker\n" + obj_text(tests::make_box(1, 1, 1)));
    write_file(folder / "box.mtl", "newmtl checker\nKd 1 1 1\nKs 0 0 0\nNs 1\nmap_Kd checker.png\n");
    tests::write_checker_png(folder / "checker.png", 8, 16);

    tests::AssetMesh left = tests::make_sphere(0.5, 32, 16), right = left;
    for (auto& p : left.positions)
        p[0] -= 0.6f;
    for (auto& p : right.positions)
        p[0] += 0.6f;
    write_file(folder / "two_materials.obj",
               "mtllib two_materials.mtl\no red\nusemtl red\n" + obj_text(left) + "o shiny\nusemtl shiny\n" +
                   obj_text(right, 1 + left.positions.size()));
    write_file(folder / "two_materials.mtl",
               "newmtl red\nKd 0.8 0.1 0.1\nKs 0 0 0\nNs 1\n\nnewmtl shiny\nKd 0.1 0.2 0.6\nKs 0.5 0.5 "
               "0.5\nNs 64\n");
}

// base (box) and arm at the root; arm holds hand (ball), and hand holds tip (box): each placed within its
// parent.
void write_parts(const std::filesystem::path& folder)
{
    const std::vector<tests::GltfMesh> meshes{{tests::make_box(1, 0.2, 1), {0.5f, 0.5f, 0.5f}},
                                              {tests::make_sphere(0.5, 32, 16), {0.2f, 0.5f, 0.8f}}};
    const std::vector<tests::GltfNode> nodes{
        {"base", 0, {}, R"("translation":[0,-0.1,0])"},
        {"arm", -1, {2}, R"("translation":[0,1,0])"},
        {"hand", 1, {3}, R"("translation":[0.5,0,0],"scale":[0.5,0.5,0.5])"},
        {"tip", 0, {}, R"("translation":[0,2,0],"rotation":[0,0,0.7071067811865476,0.7071067811865476])"}};
    write_file(folder / "parts.glb", glb_bytes(gltf_text(meshes, nodes, {0, 1}, "")));
}

// A box of 1 x 2 x 4 as those would write it whose units and axes are others.
void write_frames(const std::filesystem::path& folder)
{
    const tests::AssetMesh box = tests::make_box(1, 2, 4);
    write_file(folder / "inches_z_up.dae",
               collada_text(box, {.asset = "<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Z_UP</up_axis>"}));
    write_file(folder / "x_up.dae", collada_text(box, {.asset = "<up_axis>X_UP</up_axis>"}));
    write_file(folder / "inches_z_up.fbx", fbx_bytes(box, {.up_axis = 2, .unit_cm = 2.54}));
    write_file(folder / "x_up_ascii.fbx", fbx_text(box, {.up_axis = 0, .unit_cm = 100}));
    write_file(folder / "box.3ds", three_ds_bytes(box));
}

void write_all(const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder);
    write_knot(folder);
    write_with_materials(folder);
    write_parts(folder);
    write_frames(folder);
    write_file(folder / "sphere.obj", "o sphere\n" + obj_text(tests::make_sphere(0.5, 64, 32)));
    write_file(folder / "sphere.ply", ply_bytes(tests::make_sphere(0.5, 64, 32), Encoding::binary));
    write_file(folder / "strips.ply",
               ply_strips_bytes(tests::make_sphere(0.5, 48, 24), tests::sphere_strips(48, 24)));
    write_file(folder / "terrain.ply",
               ply_bytes(tests::make_terrain(224), Encoding::binary)); // 100352 triangles
    tests::write_images(folder / "images");
    tests::write_broken_files(folder / "broken");
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: heliograph-make-assets FOLDER\n");
        return 2;
    }
    try {
        write_all(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "heliograph-make-assets: %s\n", error.what());
        return 1;
    }
    return 0;
}
