#include "tests/assets/write_scenes.h"

#include "tests/assets/write_files.h"

#include <string_view>

namespace tests {
namespace {

std::string number(std::size_t value)
{
    return std::to_string(value);
}

template <typename List>
std::string decimals(const List& list)
{
    std::string out;
    for (const auto& entry : list)
        for (const float x : entry)
            (out += out.empty() ? "" : " ") += decimal(x);
    return out;
}

std::string source(const char* id, const std::string& values, std::size_t count, const char* axes)
{
    const std::size_t each = std::string_view(axes).size();
    std::string params;
    for (const char axis : std::string_view(axes))
        params += std::string("<param name=\"") + axis + "\" type=\"float\"/>";
    return std::string("<source id=\"") + id + "\"><float_array id=\"" + id + "-array\" count=\"" +
           number(count * each) + "\">" + values + "</float_array><technique_common><accessor source=\"#" +
           id + "-array\" count=\"" + number(count) + "\" stride=\"" + number(each) + "\">" + params +
           "</accessor></technique_common></source>\n";
}

} // namespace

std::string off_text(const AssetMesh& mesh)
{
    std::string out = "OFF\n# made by formula\n" + number(mesh.positions.size()) + ' ' +
                      number(mesh.triangles.size()) + " 0\n";
    for (const auto& p : mesh.positions)
        out += decimal(p[0]) + ' ' + decimal(p[1]) + ' ' + decimal(p[2]) + '\n';
    for (const auto& t : mesh.triangles)
        out += "3 " + number(t[0]) + ' ' + number(t[1]) + ' ' + number(t[2]) + '\n';
    return out;
}

std::string collada_text(const AssetMesh& mesh, const ColladaWords& words)
{
    std::string indices;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t index : triangle)
            (indices += indices.empty() ? "" : " ") += number(index);
    return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + words.prolog +
           "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n<asset>" +
           words.asset +
           "</asset>\n<library_effects><effect id=\"red-effect\"><profile_COMMON><technique "
           "sid=\"common\"><phong>"
           "<diffuse><color>0.8 0.1 0.1 1</color></diffuse></phong></technique></profile_COMMON></effect>"
           "</library_effects>\n<library_materials><material id=\"red\" name=\"red\"><instance_effect "
           "url=\"#red-effect\"/></material></library_materials>\n<library_geometries><geometry "
           "id=\"mesh\"><mesh>\n" +
           source("positions", decimals(mesh.positions), mesh.positions.size(), "XYZ") +
           source("normals", decimals(mesh.normals), mesh.normals.size(), "XYZ") +
           "<vertices id=\"vertices\"><input semantic=\"POSITION\" source=\"#positions\"/><input "
           "semantic=\"NORMAL\" source=\"#normals\"/></vertices>\n<triangles material=\"m\" count=\"" +
           number(mesh.triangles.size()) +
           "\"><input semantic=\"VERTEX\" source=\"#vertices\" offset=\"0\"/><p>" + indices +
           "</p></triangles>\n</mesh></geometry></library_geometries>\n" + words.libraries +
           "<library_visual_scenes><visual_scene id=\"scene\">" + words.nodes +
           "</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene "
           "url=\"#scene\"/></scene>\n</COLLADA>\n";
}

namespace {

// 3DS: a chunk is its identifier, its size with these six bytes, and what is in it.
std::string chunk(std::uint16_t id, const std::string& inside)
{
    std::string out;
    append(out, id);
    append(out, static_cast<std::uint32_t>(6 + inside.size()));
    return out + inside;
}

} // namespace

std::string three_ds_bytes(const AssetMesh& mesh, const ThreeDsWords& words)
{
    std::string vertices, faces;
    append(vertices, static_cast<std::uint16_t>(mesh.positions.size()));
    for (const auto& p : mesh.positions)
        for (const float x : p)
            append(vertices, x);
    append(faces, static_cast<std::uint16_t>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle)
            append(faces, static_cast<std::uint16_t>(index));
        append(faces, std::uint16_t{7}); // edges that are drawn
    }
    const std::string name("ball\0", 5);
    const std::string object =
        chunk(0x4000, name + chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces)));
    std::string tracks;
    for (const auto& [id, parent] : words.nodes) {
        std::string head = name, number_of_node;
        append(head, std::uint32_t{0});
        append(head, parent);
        append(number_of_node, id);
        tracks += chunk(0xb002, chunk(0xb030, number_of_node) + chunk(0xb010, head));
    }
    std::string version;
    append(version, std::uint32_t{3});
    return chunk(0x4d4d,
                 chunk(0x0002, version) + chunk(0x3d3d, object) +
                     (tracks.empty() ? "" : chunk(0xb000, tracks)));
}

} // namespace tests
