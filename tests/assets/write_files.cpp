#include "tests/assets/write_files.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace tests {
namespace {

std::string triple(const std::array<float, 3>& v)
{
    return decimal(v[0]) + ' ' + decimal(v[1]) + ' ' + decimal(v[2]);
}

std::array<float, 3> face_normal(const AssetMesh& mesh, const std::array<std::uint32_t, 3>& triangle)
{
    const auto& a = mesh.positions[triangle[0]];
    const auto& b = mesh.positions[triangle[1]];
    const auto& c = mesh.positions[triangle[2]];
    const std::array<double, 3> e{double(b[0]) - a[0], double(b[1]) - a[1], double(b[2]) - a[2]};
    const std::array<double, 3> f{double(c[0]) - a[0], double(c[1]) - a[1], double(c[2]) - a[2]};
    const std::array<double, 3> n{
        e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (length == 0) return {0, 0, 0};
    return {float(n[0] / length), float(n[1] / length), float(n[2] / length)};
}

std::string ply_header(const AssetMesh& mesh, const char* format, std::string_view faces, bool with_normals)
{
    std::string out = "ply\nformat " + std::string(format) + " 1.0\nelement vertex " +
                      std::to_string(mesh.positions.size());
    out += "\nproperty float x\nproperty float y\nproperty float z\n";
    if (with_normals)
        out +=
            "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n";
    return out + std::string(faces) + "end_header\n";
}

} // namespace

void write_file(const std::filesystem::path& path, std::string_view bytes)
{
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::string decimal(float value)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

std::string obj_text(const AssetMesh& mesh, std::size_t first_vertex)
{
    std::string out;
    for (const auto& p : mesh.positions)
        out += "v " + triple(p) + '\n';
    for (const auto& t : mesh.uvs)
        out += "vt " + decimal(t[0]) + ' ' + decimal(t[1]) + '\n';
    for (const auto& n : mesh.normals)
        out += "vn " + triple(n) + '\n';
    for (const auto& triangle : mesh.triangles) {
        out += 'f';
        for (const std::uint32_t index : triangle) {
            const std::string number = std::to_string(index + first_vertex);
            out += ' ' + number + '/' + number + '/' + number;
        }
        out += '\n';
    }
    return out;
}

std::string ply_bytes(const AssetMesh& mesh, Encoding encoding)
{
    const bool ascii = encoding == Encoding::ascii;
    const std::string faces = "element face " + std::to_string(mesh.triangles.size()) +
                              "\nproperty list uchar int vertex_indices\n";
    std::string out = ply_header(mesh, ascii ? "ascii" : "binary_little_endian", faces, true);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (ascii) {
            out += triple(mesh.positions[i]) + ' ' + triple(mesh.normals[i]) + ' ' + decimal(mesh.uvs[i][0]) +
                   ' ' + decimal(mesh.uvs[i][1]) + '\n';
            continue;
        }
        for (const float x : mesh.positions[i])
            append(out, x);
        for (const float x : mesh.normals[i])
            append(out, x);
        for (const float x : mesh.uvs[i])
            append(out, x);
    }
    for (const auto& triangle : mesh.triangles) {
        if (ascii) {
            out += '3';
            for (const std::uint32_t index : triangle)
                out += ' ' + std::to_string(index);
            out += '\n';
            continue;
        }
        append(out, std::uint8_t{3});
        for (const std::uint32_t index : triangle)
            append(out, index);
    }
    return out;
}

std::string stl_bytes(const AssetMesh& mesh, Encoding encoding)
{
    if (encoding == Encoding::ascii) {
        std::string out = "solid asset\n";
        for (const auto& triangle : mesh.triangles) {
            out += "facet normal " + triple(face_normal(mesh, triangle)) + "\n outer loop\n";
            for (const std::uint32_t index : triangle)
                out += "  vertex " + triple(mesh.positions[index]) + '\n';
            out += " endloop\nendfacet\n";
        }
        return out + "endsolid asset\n";
    }
    std::string out(80, '\0'); // must not begin with "solid", which means ASCII
    append(out, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
        for (const float x : face_normal(mesh, triangle))
            append(out, x);
        for (const std::uint32_t index : triangle)
            for (const float x : mesh.positions[index])
                append(out, x);
        append(out, std::uint16_t{0});
    }
    return out;
}

std::string ply_strips_bytes(const AssetMesh& mesh, const std::vector<std::vector<std::int32_t>>& strips)
{
    std::string out = ply_header(
        mesh, "binary_little_endian", "element tristrips 1\nproperty list int int vertex_indices\n", false);
    for (const auto& p : mesh.positions)
        for (const float x : p)
            append(out, x);
    std::size_t length = 0;
    for (const auto& strip : strips)
        length += strip.size() + 1;
    append(out, static_cast<std::int32_t>(length));
    for (const auto& strip : strips) {
        for (const std::int32_t index : strip)
            append(out, index);
        append(out, std::int32_t{-1});
    }
    return out;
}

std::vector<std::vector<std::int32_t>> sphere_strips(std::uint32_t columns, std::uint32_t rows)
{
    std::vector<std::vector<std::int32_t>> strips;
    for (std::uint32_t row = 0; row < rows; ++row) {
        std::vector<std::int32_t> strip;
        for (std::uint32_t column = 0; column <= columns; ++column) {
            const std::uint32_t lower = row * (columns + 1) + column;
            strip.push_back(static_cast<std::int32_t>(lower + columns + 1));
            strip.push_back(static_cast<std::int32_t>(lower));
        }
        strips.push_back(std::move(strip));
    }
    return strips;
}

} // namespace tests
