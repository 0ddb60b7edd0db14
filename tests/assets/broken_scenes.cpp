#include "tests/assets/broken_file.h"
#include "tests/assets/write_files.h"
#include "tests/assets/write_scenes.h"

#include <limits>

namespace tests {
namespace {

using Files = std::vector<BrokenFile>;

AssetMesh with_nan(AssetMesh mesh)
{
    mesh.positions[5][1] = std::numeric_limits<float>::quiet_NaN();
    return mesh;
}

AssetMesh with_far_index(AssetMesh mesh)
{
    mesh.triangles[7][1] = 9000;
    return mesh;
}

// 30 levels of nodes that each instance the next one twice: 2^30 balls.
std::string doubling_nodes()
{
    std::string nodes;
    for (int i = 0; i < 30; ++i) {
        const std::string next = "<instance_node url=\"#n" + std::to_string(i + 1) + "\"/>";
        nodes += "<node id=\"n" + std::to_string(i) + "\">" + next + next + "</node>";
    }
    return "<library_nodes>" + nodes +
           "<node id=\"n30\"><instance_geometry url=\"#mesh\"/></node></library_nodes>";
}

std::string doubling_entities()
{
    std::string out = "<!DOCTYPE COLLADA [<!ENTITY e0 \"0 0 0 0 0 0 0 0\">";
    for (int i = 1; i < 12; ++i) {
        const std::string before = "&e" + std::to_string(i - 1) + ";";
        out += "<!ENTITY e" + std::to_string(i) + " \"";
        for (int k = 0; k < 10; ++k)
            out += before;
        out += "\">";
    }
    return out + "]>\n";
}

// As a zip archive ends that holds nothing.
std::string zip_end()
{
    return std::string("PK\x05\x06", 4) + std::string(18, '\0');
}

void add_collada(Files& files, const AssetMesh& ball)
{
    const std::string sound = collada_text(ball);
    files.push_back({"truncated.dae", "truncated", "cut within the XML", cut(sound, 0.6)});
    files.push_back({"lying_array.dae",
                     "truncated",
                     "an array announces 4,000,000,000 floats",
                     replaced(sound, "-array\" count=\"", "-array\" count=\"4000000000\" was=\"")});
    files.push_back({"short_array.dae",
                     "truncated",
                     "an array announces one float more than it has",
                     replaced(sound,
                              "-array\" count=\"" + std::to_string(3 * ball.positions.size()) + "\"",
                              "-array\" count=\"" + std::to_string(3 * ball.positions.size() + 1) + "\"")});
    files.push_back({"lying_triangles.dae",
                     "truncated",
                     "announces 4,000,000,000 triangles",
                     replaced(sound,
                              "<triangles material=\"m\" count=\"",
                              "<triangles material=\"m\" count=\"4000000000\" was=\"")});
    files.push_back({"index_too_large.dae",
                     "index_out_of_range",
                     "a triangle with vertex 9000",
                     collada_text(with_far_index(ball))});
    files.push_back({"nan.dae", "non_finite", "vertex 5 has y = nan", collada_text(with_nan(ball))});
    files.push_back(
        {"cycle.dae",
         "malformed",
         "two nodes that instance one another",
         collada_text(
             ball,
             {.nodes = "<node id=\"a\"><instance_node url=\"#b\"/></node>",
              .libraries =
                  "<library_nodes><node id=\"b\"><instance_node url=\"#a\"/></node></library_nodes>"})});
    files.push_back(
        {"self.dae",
         "malformed",
         "a node that instances itself",
         collada_text(ball, {.nodes = "<node id=\"a\" name=\"a\"><instance_node url=\"#a\"/></node>"})});
    files.push_back({"dag_bomb.dae",
                     "over_limit",
                     "30 levels of nodes that each instance the next one twice",
                     collada_text(ball,
                                  {.nodes = "<node id=\"top\"><instance_node url=\"#n0\"/></node>",
                                   .libraries = doubling_nodes()})});
    files.push_back({"entity_bomb.dae",
                     "malformed",
                     "entities that double ten times",
                     collada_text(ball, {.prolog = doubling_entities()})});
    files.push_back(
        {"zip_behind.dae", "unsupported", "a zip archive hangs behind the XML", sound + zip_end()});
    files.push_back({"not_collada.dae",
                     "malformed,unknown_format",
                     "XML of something else",
                     "<?xml version=\"1.0\"?><svg/>\n"});
    files.push_back({"no_meshes.dae",
                     "no_triangles",
                     "nodes without meshes",
                     collada_text(ball, {.nodes = "<node id=\"a\"/>"})});
}

void add_fbx(Files& files, const AssetMesh& ball)
{
    const std::string sound = fbx_bytes(ball), text = fbx_text(ball);
    files.push_back({"truncated.fbx", "truncated", "binary, cut within a record", cut(sound, 0.6)});
    files.push_back({"truncated_head.fbx",
                     "truncated",
                     "binary, cut within the first record's head",
                     sound.substr(0, 35)});
    files.push_back({"truncated_ascii.fbx", "truncated", "cut within the objects", cut(text, 0.6)});
    std::string lying = sound;
    const std::size_t array = lying.find("Verticesd") + 9;
    for (std::size_t i = 0; i < 4; ++i)
        lying[array + i] = '\x7f';
    files.push_back({"lying_array.fbx", "malformed", "an array announces 2 billion doubles", lying});
    lying[array + 4] = 1; // compressed, as it says
    files.push_back(
        {"deflate_bomb.fbx", "malformed", "a compressed array announces more than deflate can hold", lying});
    const std::size_t star = text.find("Vertices: *") + 11;
    files.push_back({"lying_array_ascii.fbx",
                     "truncated",
                     "an array announces 4,000,000,000 numbers",
                     text.substr(0, star) + "4000000000" + text.substr(text.find(' ', star))});
    files.push_back({"index_too_large.fbx",
                     "index_out_of_range",
                     "a face with vertex 9000",
                     fbx_bytes(with_far_index(ball))});
    files.push_back({"index_too_large_ascii.fbx",
                     "index_out_of_range",
                     "a face with vertex 9000",
                     fbx_text(with_far_index(ball))});
    files.push_back({"nan.fbx", "non_finite", "vertex 5 has y = nan", fbx_bytes(with_nan(ball))});
    files.push_back({"cycle.fbx",
                     "malformed",
                     "two nodes that are each other's child",
                     fbx_bytes(ball, {.connections = {{3, 4}, {4, 3}}})});
    files.push_back({"cycle_ascii.fbx",
                     "malformed",
                     "two nodes that are each other's child",
                     fbx_text(ball, {.connections = {{3, 4}, {4, 3}}})});
    files.push_back({"self.fbx",
                     "malformed",
                     "a node that is its own child",
                     fbx_bytes(ball, {.connections = {{2, 2}}})});
}

void add_3ds(Files& files, const AssetMesh& ball)
{
    const std::string sound = three_ds_bytes(ball);
    files.push_back({"truncated.3ds", "truncated", "cut within the faces", cut(sound, 0.8)});
    std::string lying = sound;
    const std::size_t count = lying.find(std::string("\x10\x41", 2)) + 6;
    lying[count] = lying[count + 1] = '\xff';
    files.push_back({"lying_vertices.3ds", "truncated", "announces 65,535 vertices", lying});
    lying = sound;
    lying[3] = lying[4] = '\x7f';
    files.push_back({"lying_size.3ds", "truncated", "the file's size is 8 MB, it says", lying});
    files.push_back({"index_too_large.3ds",
                     "index_out_of_range",
                     "a face with vertex 9000",
                     three_ds_bytes(with_far_index(ball))});
    files.push_back({"nan.3ds", "non_finite", "vertex 5 has y = nan", three_ds_bytes(with_nan(ball))});
    files.push_back({"cycle.3ds",
                     "malformed",
                     "two nodes that are each other's parent",
                     three_ds_bytes(ball, {.nodes = {{0, 1}, {1, 0}}})});
}

void add_off(Files& files, const AssetMesh& ball)
{
    const std::string sound = off_text(ball);
    files.push_back(
        {"truncated.off", "truncated", "ends within the faces", sound.substr(0, sound.rfind("\n3 ") + 1)});
    files.push_back({"lying_counts.off",
                     "truncated",
                     "announces 4,000,000,000 vertices",
                     "OFF\n4000000000 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n"});
    files.push_back({"negative_count.off",
                     "malformed",
                     "announces -4 vertices",
                     "OFF\n-4 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"});
    files.push_back({"index_too_large.off",
                     "index_out_of_range",
                     "a face with vertex 9000",
                     off_text(with_far_index(ball))});
    files.push_back({"index_negative.off",
                     "index_out_of_range",
                     "a face with vertex -1",
                     "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"});
    files.push_back({"nan.off", "non_finite", "vertex 5 has y = nan", off_text(with_nan(ball))});
    files.push_back(
        {"binary.off", "unsupported", "says that it is binary", "OFF BINARY\n" + std::string(64, '\0')});
    files.push_back({"four.off",
                     "unsupported",
                     "of four dimensions",
                     "4OFF\n3 1 0\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"});
    files.push_back(
        {"points.off", "no_triangles", "vertices and no face", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"});
}

} // namespace

void add_broken_scenes(std::vector<BrokenFile>& files)
{
    const AssetMesh ball = make_sphere(0.5, 12, 6);
    add_collada(files, ball);
    add_fbx(files, ball);
    add_3ds(files, ball);
    add_off(files, ball);
}

} // namespace tests
