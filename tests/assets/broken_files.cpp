#include "tests/assets/broken_files.h"

#include "tests/assets/broken_file.h"
#include "tests/assets/shapes.h"
#include "tests/assets/write_files.h"

#include <limits>

namespace tests {
namespace {

using Files = std::vector<BrokenFile>;

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string
tetrahedron_ply(std::string_view vertex_count, std::string_view face_count, std::string_view last_face)
{
    return "ply\nformat ascii 1.0\nelement vertex " + std::string(vertex_count) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::string(face_count) +
           "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 "
           "3\n3 0 3 2\n" +
           std::string(last_face) + '\n';
}

void add_truncated(Files& files, const AssetMesh& sphere, const GltfText& gltf)
{
    // Cut within a face: "f 12/12/12 1" would still be an OBJ, so what is left is a face of two corners.
    std::string obj = obj_text(sphere);
    obj = obj.substr(0, obj.rfind('/', obj.rfind('/', obj.rfind(' ') - 1) - 1) + 1);
    files.push_back(
        {"truncated.obj", "truncated,malformed,index_out_of_range", "cut within the last face", obj});
    files.push_back({"truncated_vertices.obj",
                     "no_triangles,truncated,malformed",
                     "cut within the vertices",
                     cut(obj, 0.1)});
    files.push_back({"truncated.ply",
                     "truncated",
                     "binary, cut within the faces",
                     cut(ply_bytes(sphere, Encoding::binary), 0.9)});
    files.push_back({"truncated_vertices.ply",
                     "truncated",
                     "binary, cut within the vertices",
                     cut(ply_bytes(sphere, Encoding::binary), 0.3)});
    files.push_back({"truncated_ascii.ply",
                     "truncated,malformed",
                     "cut within the faces",
                     cut(ply_bytes(sphere, Encoding::ascii), 0.9)});
    files.push_back({"truncated_header.ply",
                     "truncated,malformed",
                     "ends within the header",
                     "ply\nformat ascii 1.0\nelement ver"});
    const std::string strips = ply_strips_bytes(sphere, sphere_strips(12, 6));
    files.push_back({"truncated_strips.ply", "truncated", "cut within the strips", cut(strips, 0.8)});
    files.push_back({"truncated.stl",
                     "truncated",
                     "binary, cut within a triangle",
                     cut(stl_bytes(sphere, Encoding::binary), 0.7)});
    files.push_back({"truncated_ascii.stl",
                     "truncated,malformed",
                     "cut within a facet",
                     cut(stl_bytes(sphere, Encoding::ascii), 0.7)});
    files.push_back(
        {"truncated.glb", "truncated,malformed", "cut within the binary chunk", cut(glb_bytes(gltf), 0.8)});
    files.push_back({"truncated_json.glb",
                     "truncated,malformed",
                     "cut within the JSON chunk",
                     glb_bytes(gltf).substr(0, 200)});
    files.push_back({"truncated.gltf", "truncated,malformed", "cut within the JSON", cut(gltf.json, 0.6)});
}

void add_lying_headers(Files& files, const AssetMesh& sphere, const GltfText& gltf)
{
    const std::string four_billion = "4000000000";
    files.push_back({"lying_vertices.ply",
                     "truncated,malformed,over_limit",
                     "header announces 4,000,000,000 vertices",
                     tetrahedron_ply(four_billion, "4", "3 1 2 3")});
    files.push_back({"lying_faces.ply",
                     "truncated,malformed,over_limit",
                     "header announces 4,000,000,000 faces",
                     tetrahedron_ply("4", four_billion, "3 1 2 3")});
    files.push_back({"negative_count.ply",
                     "malformed,truncated",
                     "header announces -4 vertices",
                     tetrahedron_ply("-4", "4", "3 1 2 3")});
    std::string stl = stl_bytes(sphere, Encoding::binary);
    for (std::size_t i = 80; i < 84; ++i)
        stl[i] = '\xff';
    files.push_back({"lying_count.stl",
                     "truncated,malformed,over_limit",
                     "header announces 4,294,967,295 triangles",
                     stl});
    const std::string strips = ply_strips_bytes(sphere, sphere_strips(12, 6));
    std::string lying = strips;
    const std::size_t count_at = strips.find("end_header\n") + 11 + sphere.positions.size() * 12;
    lying[count_at + 3] = '\x7f';
    files.push_back({"lying_strips.ply",
                     "truncated,malformed,over_limit",
                     "strip list announces 2 billion indices",
                     lying});
    std::string glb = glb_bytes(gltf);
    for (std::size_t i = 8; i < 16; ++i)
        glb[i] = '\x7f';
    files.push_back({"lying_lengths.glb", "truncated,malformed", "file and chunk length of 2 GB", glb});
    const std::string buffer_length = "\"byteLength\":" + std::to_string(gltf.buffer.size());
    const std::string lying_json = replaced(gltf.json, buffer_length + "}]}", "\"byteLength\":999999999}]}");
    files.push_back({"lying_buffer.glb",
                     "truncated,malformed",
                     "buffer.byteLength beyond the chunk",
                     glb_bytes({lying_json, gltf.buffer})});
    const std::string count = "\"count\":" + std::to_string(sphere.positions.size());
    files.push_back({"lying_accessor.glb",
                     "malformed,truncated,index_out_of_range",
                     "accessor.count of 1,000,000,000",
                     glb_bytes({replaced(gltf.json, count, "\"count\":1000000000"), gltf.buffer})});
}

void add_bad_numbers(Files& files, const AssetMesh& sphere, const GltfText& gltf)
{
    files.push_back(
        {"nan.obj", "non_finite", "a vertex of nan", replaced(kTetrahedron, "v 1 0 0", "v nan 0 0")});
    files.push_back({"infinite.obj",
                     "non_finite",
                     "a vertex of 1e999",
                     replaced(kTetrahedron, "v 1 0 0", "v 1e999 0 0")});
    files.push_back({"not_a_number.obj",
                     "malformed,non_finite",
                     "a vertex of letters",
                     replaced(kTetrahedron, "v 1 0 0", "v one 0 0")});
    AssetMesh bad = sphere;
    bad.positions[5][1] = std::numeric_limits<float>::quiet_NaN();
    files.push_back({"nan.ply", "non_finite", "vertex 5 has y = nan", ply_bytes(bad, Encoding::binary)});
    files.push_back(
        {"nan_ascii.ply", "non_finite,malformed", "vertex 5 has y = nan", ply_bytes(bad, Encoding::ascii)});
    bad.positions[5][1] = std::numeric_limits<float>::infinity();
    files.push_back({"infinite.ply", "non_finite", "vertex 5 has y = inf", ply_bytes(bad, Encoding::binary)});
    files.push_back({"infinite.stl", "non_finite", "a vertex has y = inf", stl_bytes(bad, Encoding::binary)});
    std::string buffer = gltf.buffer;
    for (std::size_t i = 60; i < 64; ++i)
        buffer[i] = '\xff';
    files.push_back({"nan.glb", "non_finite", "vertex 5 has x = nan", glb_bytes({gltf.json, buffer})});
}

void add_bad_indices(Files& files, const AssetMesh& sphere)
{
    files.push_back({"index_too_large.obj",
                     "index_out_of_range",
                     "face of vertex 99 of 4",
                     replaced(kTetrahedron, "f 2 3 4", "f 2 3 99")});
    files.push_back({"index_too_negative.obj",
                     "index_out_of_range",
                     "face of vertex -5 of 4",
                     replaced(kTetrahedron, "f 2 3 4", "f 2 3 -5")});
    files.push_back({"index_zero.obj",
                     "index_out_of_range,malformed",
                     "OBJ counts from 1",
                     replaced(kTetrahedron, "f 2 3 4", "f 2 3 0")});
    files.push_back({"index_huge.obj",
                     "index_out_of_range,malformed",
                     "does not fit 32 bits, nor 64",
                     replaced(kTetrahedron, "f 2 3 4", "f 2 3 99999999999999999999")});
    files.push_back({"index_uv.obj",
                     "index_out_of_range,ok",
                     "vt 7 of none",
                     replaced(kTetrahedron, "f 2 3 4", "f 2/7 3/7 4/7")});
    files.push_back({"index_too_large.ply",
                     "index_out_of_range",
                     "face of vertex 4 of 4",
                     tetrahedron_ply("4", "4", "3 1 2 4")});
    files.push_back({"index_negative.ply",
                     "index_out_of_range,malformed",
                     "face of vertex -1",
                     tetrahedron_ply("4", "4", "3 1 2 -1")});
    auto strips = sphere_strips(12, 6);
    strips[2][3] = 100'000;
    files.push_back({"index_strips.ply",
                     "index_out_of_range",
                     "strip with vertex 100000",
                     ply_strips_bytes(sphere, strips)});
    AssetMesh bad = sphere;
    bad.triangles[7][1] = 70'000;
    files.push_back({"index_too_large.glb",
                     "index_out_of_range,malformed",
                     "triangle with vertex 70000",
                     glb_bytes(gltf_text({{bad}}, {{"ball", 0, {}, ""}}, {0}, ""))});
}

void add_without_triangles(Files& files, const AssetMesh& sphere)
{
    AssetMesh bare = sphere;
    bare.triangles.clear();
    files.push_back({"empty.obj", "truncated,no_triangles,empty,unknown_format", "no bytes", ""});
    files.push_back({"empty.ply", "truncated,no_triangles,empty,unknown_format,malformed", "no bytes", ""});
    files.push_back({"empty.stl", "truncated,no_triangles,empty,unknown_format,malformed", "no bytes", ""});
    files.push_back({"empty.glb", "truncated,no_triangles,empty,unknown_format,malformed", "no bytes", ""});
    files.push_back(
        {"points.obj", "no_triangles", "vertices and no face", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n"});
    files.push_back(
        {"lines.obj", "no_triangles", "lines and no face", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n"});
    files.push_back(
        {"points.ply", "no_triangles", "vertices and no face", ply_bytes(bare, Encoding::binary)});
    files.push_back(
        {"no_triangles.stl", "no_triangles", "announces 0 triangles", stl_bytes(bare, Encoding::binary)});
    files.push_back({"no_triangles_ascii.stl",
                     "no_triangles",
                     "solid without facets",
                     "solid nothing\nendsolid nothing\n"});
    files.push_back(
        {"no_meshes.gltf",
         "no_triangles",
         "nodes without meshes",
         R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"empty"}]})"});
}

// xorshift64: noise that is the same everywhere.
std::string noise(std::size_t size)
{
    std::string out;
    for (std::uint64_t state = 88172645463325252u; out.size() < size;) {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        append(out, state);
    }
    return out;
}

void add_foreign(Files& files, const AssetMesh& sphere)
{
    files.push_back(
        {"random.obj", "no_triangles,malformed,unknown_format,truncated", "random bytes", noise(4096)});
    files.push_back(
        {"random.ply", "malformed,unknown_format,truncated,no_triangles", "random bytes", noise(4096)});
    files.push_back(
        {"random_after_header.ply",
         "index_out_of_range,non_finite,malformed,truncated",
         "random bytes after a good header",
         "ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\nproperty float "
         "y\nproperty float z\nelement face 100\nproperty list uchar int vertex_indices\nend_header\n" +
             noise(4096)});
    files.push_back({"random.stl",
                     "malformed,unknown_format,truncated,non_finite,no_triangles,over_limit",
                     "random bytes",
                     noise(4096)});
    files.push_back(
        {"random.glb", "malformed,unknown_format,truncated,no_triangles", "random bytes", noise(4096)});
    files.push_back({"random.bin", "unknown_format", "random bytes of no format", noise(4096)});
    files.push_back({"zeros.obj",
                     "no_triangles,malformed,unknown_format,truncated",
                     "4096 zero bytes",
                     std::string(4096, '\0')});
    files.push_back({"ply_named.obj",
                     "ok",
                     "a good PLY under a wrong name: told by its content",
                     ply_bytes(sphere, Encoding::binary)});
    files.push_back({"stl_named.ply",
                     "ok,malformed,unknown_format,truncated",
                     "a good binary STL under a wrong name",
                     stl_bytes(sphere, Encoding::binary)});
    files.push_back({"obj_named.glb",
                     "ok,malformed,unknown_format,truncated",
                     "a good OBJ under a wrong name",
                     kTetrahedron});
    files.push_back({"picture.obj",
                     "no_triangles,malformed,unknown_format,truncated",
                     "a PNG's first bytes",
                     std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + noise(256)});
}

std::string scene_graph(const std::string& nodes)
{
    const GltfText text = gltf_text({{make_box(1, 1, 1)}}, {{"placeholder", 0, {}, ""}}, {0}, "");
    const std::string empty = R"({"name":"placeholder","mesh":0})";
    return glb_bytes({replaced(text.json, empty, nodes), text.buffer});
}

void add_traps(Files& files)
{
    // Node i lists node i + 1 twice: 2^30 instances of one box out of some 700 bytes.
    std::string nodes;
    for (int i = 1; i <= 30; ++i)
        nodes += "{\"children\":[" + std::to_string(i) + ',' + std::to_string(i) + "]},";
    files.push_back({"dag_bomb.glb",
                     "malformed,over_limit,cyclic,not_a_tree",
                     "30 levels of nodes that each list the same child twice",
                     scene_graph(nodes + R"({"mesh":0})")});
    files.push_back({"cycle.glb",
                     "malformed,over_limit,cyclic,not_a_tree",
                     "node 0 is its own grandchild",
                     scene_graph(R"({"children":[1]},{"children":[2]},{"mesh":0,"children":[0]})")});
    files.push_back({"self.glb",
                     "malformed,over_limit,cyclic,not_a_tree",
                     "node 0 is its own child",
                     scene_graph(R"({"mesh":0,"children":[0]})")});
    std::string chain;
    for (int i = 1; i < 20'000; ++i)
        chain += "{\"children\":[" + std::to_string(i) + "]},";
    files.push_back({"deep_chain.glb",
                     "malformed,over_limit,ok",
                     "20,000 nodes deep",
                     scene_graph(chain + R"({"mesh":0})")});
    std::string nested = R"({"asset":{"version":"2.0"},"extras":)";
    nested += std::string(100'000, '[') + std::string(100'000, ']') + '}';
    files.push_back({"nested.gltf", "malformed,no_triangles,over_limit", "JSON 100,000 deep", nested});
    const GltfText away =
        gltf_text({{make_box(1, 1, 1)}}, {{"box", 0, {}, ""}}, {0}, "../../../../../../etc/passwd");
    files.push_back(
        {"uri_passwd.gltf", "missing_file,malformed", "buffer uri ../../../../../../etc/passwd", away.json});
    files.push_back({"uri_absolute.gltf",
                     "missing_file,malformed",
                     "buffer uri /etc/passwd",
                     replaced(away.json, "../../../../../../etc/passwd", "/etc/passwd")});
    files.push_back({"uri_http.gltf",
                     "missing_file,malformed",
                     "buffer uri http://127.0.0.1:9/x.bin",
                     replaced(away.json, "../../../../../../etc/passwd", "http://127.0.0.1:9/x.bin")});
    files.push_back({"mtllib_passwd.obj",
                     "ok",
                     "mtllib ../../../../../../etc/passwd: imports without it, with a note",
                     std::string("mtllib ../../../../../../etc/passwd\nusemtl root\n") + kTetrahedron});
    files.push_back({"mtllib_absolute.obj",
                     "ok",
                     "mtllib /etc/passwd: imports without it, with a note",
                     std::string("mtllib /etc/passwd\nusemtl root\n") + kTetrahedron});
    files.push_back({"long_line.obj",
                     "no_triangles,malformed,index_out_of_range,truncated",
                     "one line of 1 MiB",
                     std::string("f ").append(1 << 20, '1') + '\n'});
}

} // namespace

void write_broken_files(const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder);
    const AssetMesh sphere = make_sphere(0.5, 12, 6);
    const GltfText gltf = gltf_text({{sphere}}, {{"ball", 0, {}, ""}}, {0}, "");
    Files files;
    add_truncated(files, sphere, gltf);
    add_lying_headers(files, sphere, gltf);
    add_bad_numbers(files, sphere, gltf);
    add_bad_indices(files, sphere);
    add_without_triangles(files, sphere);
    add_foreign(files, sphere);
    add_traps(files);
    add_broken_scenes(files);
    std::string manifest;
    for (const BrokenFile& file : files) {
        write_file(folder / file.name, file.bytes);
        manifest += file.name + '\t' + file.codes + '\t' + file.what + '\n';
    }
    write_file(folder / "manifest.tsv", manifest);
}

} // namespace tests
