// heliograph-bench terrain FILE: writes a terrain as a mesh file, a row at a time.
#include "tests/bench/commands.h"
#include "tests/bench/terrain.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

namespace bench {

namespace {

using renderer::Vec3f;

static_assert(std::endian::native == std::endian::little);

template <typename T>
void append(std::string& out, T value)
{
    const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
    out.append(bytes.data(), bytes.size());
}

template <typename T>
void append_decimal(std::string& out, T value)
{
    std::array<char, 32> text{};
    out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
}

class File {
public:
    explicit File(const std::filesystem::path& path)
        : path_(path), stream_(path, std::ios::binary | std::ios::trunc)
    {
    }
    // `add(text, i)` appends what item i is, for all of `count`.
    template <typename Count, typename Add>
    void items(Count count, const Add& add)
    {
        constexpr std::size_t kPiece = 1 << 20;
        for (Count i = 0; i < count; ++i) {
            add(text_, i);
            if (text_.size() >= kPiece) flush();
        }
        flush();
    }
    void text(const std::string& piece)
    {
        text_ += piece;
        flush();
    }
    std::uint64_t finish()
    {
        if (!stream_.flush()) throw std::runtime_error("cannot write " + path_.string());
        return written_;
    }

private:
    void flush()
    {
        stream_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
        written_ += text_.size();
        text_.clear();
    }
    std::filesystem::path path_;
    std::ofstream stream_;
    std::string text_;
    std::uint64_t written_ = 0;
};

void append_corners(std::string& out, Vec3f p)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        append(out, p[axis]);
}

void write_ply(File& file, const Terrain& terrain)
{
    file.text("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(terrain.vertices()) +
              "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
              std::to_string(terrain.triangles()) + "\nproperty list uchar int vertex_indices\nend_header\n");
    file.items(terrain.vertices(),
               [&](std::string& out, std::uint32_t i) { append_corners(out, terrain.vertex(i)); });
    file.items(terrain.triangles(), [&](std::string& out, std::uint64_t i) {
        append(out, std::uint8_t{3});
        for (const std::uint32_t index : terrain.triangle(i))
            append(out, index);
    });
}

void write_obj(File& file, const Terrain& terrain)
{
    file.items(terrain.vertices(), [&](std::string& out, std::uint32_t i) {
        const Vec3f p = terrain.vertex(i);
        out += 'v';
        for (std::size_t axis = 0; axis < 3; ++axis)
            append_decimal(out += ' ', p[axis]);
        out += '\n';
    });
    file.items(terrain.triangles(), [&](std::string& out, std::uint64_t i) {
        out += 'f';
        for (const std::uint32_t index : terrain.triangle(i))
            append_decimal(out += ' ', index + 1);
        out += '\n';
    });
}

void write_stl(File& file, const Terrain& terrain)
{
    std::string head(80, ' ');
    append(head, static_cast<std::uint32_t>(terrain.triangles()));
    file.text(head);
    file.items(terrain.triangles(), [&](std::string& out, std::uint64_t i) {
        append_corners(out, {});
        for (const std::uint32_t index : terrain.triangle(i))
            append_corners(out, terrain.vertex(index));
        append(out, std::uint16_t{0});
    });
}

void write_glb(File& file, const Terrain& terrain)
{
    const std::uint64_t vertex_bytes = std::uint64_t(terrain.vertices()) * 12,
                        index_bytes = terrain.triangles() * 12, bytes = vertex_bytes + index_bytes;
    Vec3f lower{1, 1, 1}, upper{-1, -1, -1};
    for (std::uint32_t i = 0; i < terrain.vertices(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], terrain.vertex(i)[axis]);
            upper[axis] = std::max(upper[axis], terrain.vertex(i)[axis]);
        }
    const auto list = [](Vec3f p) {
        std::string out(1, '[');
        for (std::size_t axis = 0; axis < 3; ++axis)
            append_decimal(out += axis ? "," : "", p[axis]);
        return out + ']';
    };
    std::string json =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"terrain","mesh":0}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
        R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":)" +
        std::to_string(terrain.vertices()) + R"(,"min":)" + list(lower) + R"(,"max":)" + list(upper) +
        R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" +
        std::to_string(terrain.triangles() * 3) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" +
        std::to_string(vertex_bytes) + R"(},{"buffer":0,"byteOffset":)" + std::to_string(vertex_bytes) +
        R"(,"byteLength":)" + std::to_string(index_bytes) + R"(}],"buffers":[{"byteLength":)" +
        std::to_string(bytes) + "}]}";
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::uint64_t whole = 12 + 8 + json.size() + 8 + bytes;
    if (whole > 0xffffffff) throw std::invalid_argument("a GLB has at most 4 GiB");
    std::string head = "glTF";
    append(head, std::uint32_t{2});
    append(head, static_cast<std::uint32_t>(whole));
    append(head, static_cast<std::uint32_t>(json.size()));
    head += "JSON" + json;
    append(head, static_cast<std::uint32_t>(bytes));
    head.append("BIN\0", 4);
    file.text(head);
    file.items(terrain.vertices(),
               [&](std::string& out, std::uint32_t i) { append_corners(out, terrain.vertex(i)); });
    file.items(terrain.triangles(), [&](std::string& out, std::uint64_t i) {
        for (const std::uint32_t index : terrain.triangle(i))
            append(out, index);
    });
}

} // namespace

std::uint64_t write_terrain(const std::filesystem::path& path, std::uint64_t triangles)
{
    const Terrain terrain(triangles);
    const std::string extension = path.extension().string();
    File file(path);
    if (extension == ".ply")
        write_ply(file, terrain);
    else if (extension == ".obj")
        write_obj(file, terrain);
    else if (extension == ".stl")
        write_stl(file, terrain);
    else if (extension == ".glb")
        write_glb(file, terrain);
    else
        throw std::invalid_argument("a terrain is written as .ply, .obj, .stl or .glb, not " + extension);
    return file.finish();
}

void run_terrain(const TerrainOptions& options)
{
    std::printf("%s: %llu triangles, %llu bytes\n",
                options.path.c_str(),
                static_cast<unsigned long long>(options.triangles),
                static_cast<unsigned long long>(write_terrain(options.path, options.triangles)));
}

} // namespace bench
