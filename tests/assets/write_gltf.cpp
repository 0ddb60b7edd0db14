#include "tests/assets/write_files.h"

#include <algorithm>
#include <bit>

namespace tests {
namespace {

std::string json_list(const std::vector<int>& numbers)
{
    std::string out;
    for (const int number : numbers)
        out += (out.empty() ? "" : ",") + std::to_string(number);
    return '[' + out + ']';
}

std::string json_triple(const std::array<float, 3>& v)
{
    return '[' + decimal(v[0]) + ',' + decimal(v[1]) + ',' + decimal(v[2]) + ']';
}

// The growing lists of one glTF file.
struct GltfLists {
    std::string buffer, views, accessors, meshes, materials, nodes;
    int count = 0; // of views and accessors alike

    int add(std::size_t start, std::size_t elements, const char* type, int component, const std::string& more)
    {
        if (count > 0) {
            views += ',';
            accessors += ',';
        }
        views += "{\"buffer\":0,\"byteOffset\":" + std::to_string(start) +
                 ",\"byteLength\":" + std::to_string(buffer.size() - start) + '}';
        accessors += "{\"bufferView\":" + std::to_string(count) +
                     ",\"componentType\":" + std::to_string(component) +
                     ",\"count\":" + std::to_string(elements) + ",\"type\":\"" + type + '"' + more + '}';
        return count++;
    }
};

constexpr int kFloat = 5126, kUnsignedInt = 5125; // componentType, glTF 2.0 section 3.6.2.2

void add_mesh(GltfLists& lists, const GltfMesh& item, std::size_t number)
{
    const AssetMesh& mesh = item.mesh;
    std::array<float, 3> lower = mesh.positions.front(), upper = lower;
    std::size_t start = lists.buffer.size();
    for (const auto& p : mesh.positions) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            append(lists.buffer, p[axis]);
            lower[axis] = std::min(lower[axis], p[axis]);
            upper[axis] = std::max(upper[axis], p[axis]);
        }
    }
    const std::string bounds = ",\"min\":" + json_triple(lower) + ",\"max\":" + json_triple(upper);
    const int positions = lists.add(start, mesh.positions.size(), "VEC3", kFloat, bounds);
    start = lists.buffer.size();
    for (const auto& n : mesh.normals)
        for (const float x : n)
            append(lists.buffer, x);
    const int normals = lists.add(start, mesh.normals.size(), "VEC3", kFloat, "");
    start = lists.buffer.size();
    for (const auto& t : mesh.uvs)
        for (const float x : t)
            append(lists.buffer, x);
    const int uvs = lists.add(start, mesh.uvs.size(), "VEC2", kFloat, "");
    start = lists.buffer.size();
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t index : triangle)
            append(lists.buffer, index);
    const int indices = lists.add(start, mesh.triangles.size() * 3, "SCALAR", kUnsignedInt, "");

    const std::string comma = number > 0 ? "," : "";
    lists.meshes += comma + "{\"primitives\":[{\"attributes\":{\"POSITION\":" + std::to_string(positions) +
                    ",\"NORMAL\":" + std::to_string(normals) + ",\"TEXCOORD_0\":" + std::to_string(uvs) +
                    "},\"indices\":" + std::to_string(indices) + ",\"material\":" + std::to_string(number) +
                    "}]}";
    const auto& c = item.base_color;
    lists.materials += comma + "{\"name\":\"material" + std::to_string(number) +
                       "\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[" + decimal(c[0]) + ',' +
                       decimal(c[1]) + ',' + decimal(c[2]) +
                       ",1],\"metallicFactor\":0,\"roughnessFactor\":0.8}}";
}

void add_node(GltfLists& lists, const GltfNode& node)
{
    if (!lists.nodes.empty()) lists.nodes += ',';
    lists.nodes += "{\"name\":\"" + node.name + '"';
    if (node.mesh >= 0) lists.nodes += ",\"mesh\":" + std::to_string(node.mesh);
    if (!node.children.empty()) lists.nodes += ",\"children\":" + json_list(node.children);
    if (!node.placement.empty()) lists.nodes += ',' + node.placement;
    lists.nodes += '}';
}

} // namespace

GltfText gltf_text(const std::vector<GltfMesh>& meshes,
                   const std::vector<GltfNode>& nodes,
                   const std::vector<int>& roots,
                   const std::string& buffer_uri)
{
    GltfLists lists;
    for (std::size_t i = 0; i < meshes.size(); ++i)
        add_mesh(lists, meshes[i], i);
    for (const GltfNode& node : nodes)
        add_node(lists, node);
    const std::string uri = buffer_uri.empty() ? "" : "\"uri\":\"" + buffer_uri + "\",";
    std::string json =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":" + json_list(roots) + "}],";
    json += "\"nodes\":[" + lists.nodes + "],\n\"meshes\":[" + lists.meshes + "],\n\"materials\":[" +
            lists.materials + "],\n\"accessors\":[" + lists.accessors + "],\n\"bufferViews\":[" +
            lists.views + "],\n\"buffers\":[{" + uri +
            "\"byteLength\":" + std::to_string(lists.buffer.size()) + "}]}\n";
    return {std::move(json), std::move(lists.buffer)};
}

std::string glb_bytes(const GltfText& text)
{
    std::string json = text.json, buffer = text.buffer;
    json.resize((json.size() + 3) / 4 * 4, ' '); // chunks are padded to 4 bytes, glTF 2.0 section 4.4.3
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    std::string out = "glTF";
    append(out, std::uint32_t{2});
    append(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
    append(out, static_cast<std::uint32_t>(json.size()));
    out += "JSON" + json;
    append(out, static_cast<std::uint32_t>(buffer.size()));
    out.append("BIN\0", 4);
    return out + buffer;
}

} // namespace tests
