// Writers of the mesh formats: an AssetMesh as the bytes of a file. Binary formats are little-endian.
#pragma once

#include "tests/assets/shapes.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tests {

// Writes the whole file or throws std::runtime_error with the path.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// The shortest decimal that reads back as `value`.
std::string decimal(float value);

// Appends the object representation: little-endian on every machine that we build for.
template <typename T>
void append(std::string& out, T value)
{
    static_assert(std::is_arithmetic_v<T>);
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    out.append(bytes.data(), bytes.size());
}

// v/vt/vn lines and faces; indices go on from `first_vertex` (1 for the first mesh of a file).
std::string obj_text(const AssetMesh& mesh, std::size_t first_vertex = 1);

enum class Encoding : std::uint8_t { ascii, binary };
std::string ply_bytes(const AssetMesh& mesh, Encoding encoding);
std::string stl_bytes(const AssetMesh& mesh, Encoding encoding);

// As scanners of the nineties wrote it: positions, and one list of triangle strips, parted by -1.
// `strips` holds vertex indices; the second triangle of a strip is turned around, as OpenGL has it.
std::string ply_strips_bytes(const AssetMesh& mesh, const std::vector<std::vector<std::int32_t>>& strips);
// The strips of make_sphere(radius, columns, rows).
std::vector<std::vector<std::int32_t>> sphere_strips(std::uint32_t columns, std::uint32_t rows);

// A node of a glTF scene; `mesh` and `children` are indices, -1 and empty where there is none.
struct GltfNode {
    std::string name;
    int mesh = -1;
    std::vector<int> children;
    std::string placement; // more members, as JSON: "\"translation\":[1,0,0]"
};
struct GltfMesh {
    AssetMesh mesh;
    std::array<float, 3> base_color{0.8f, 0.8f, 0.8f};
};
struct GltfText {
    std::string json;   // with `buffer_uri` unless that is empty, as in GLB
    std::string buffer; // vertices and indices
};
GltfText gltf_text(const std::vector<GltfMesh>& meshes,
                   const std::vector<GltfNode>& nodes,
                   const std::vector<int>& roots,
                   const std::string& buffer_uri);
std::string glb_bytes(const GltfText& text);

// RGB, 8 bits, `squares` x `squares` squares of `side` pixels in two colours.
void write_checker_png(const std::filesystem::path& path, int squares, int side);

} // namespace tests
