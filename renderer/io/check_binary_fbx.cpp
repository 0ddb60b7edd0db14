#include "renderer/io/fbx_models.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/read_fbx.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace renderer {

namespace {

using Check = std::optional<ImportFault>;

constexpr std::size_t kHeadBytes = 27;        // magic, version
constexpr std::uint32_t kFirstWide = 7500;    // version whose records count in 64 bits
constexpr std::uint64_t kMostInflated = 1032; // bytes that a byte of deflate can stand for
constexpr int kDeepest = 64;

// What a property may be asked for, as far as it matters here.
struct Property {
    char type = 0;
    std::int64_t number = 0;  // of an integer
    std::string_view bytes;   // of text, and of an array that is not compressed
    std::uint64_t length = 0; // of an array
    bool is_array = false, is_plain = false;
};

std::size_t scalar_bytes(char type)
{
    switch (type) {
    case 'C':
    case 'B':
        return 1;
    case 'Y':
        return 2;
    case 'I':
    case 'F':
        return 4;
    case 'L':
    case 'D':
        return 8;
    default:
        return 0;
    }
}

std::size_t element_bytes(char type)
{
    return type == 'f' || type == 'i'   ? 4
           : type == 'd' || type == 'l' ? 8
           : type == 'b' || type == 'c' ? 1
                                        : 0;
}

class BinaryFbx {
public:
    BinaryFbx(std::string_view bytes, const Limits& limits) : bytes_(bytes), limits_(limits) {}

    Check run()
    {
        if (bytes_.size() < kHeadBytes) return fault("truncated", 0, "a binary FBX has at least 27 bytes");
        const auto version = static_cast<std::uint32_t>(number(23, 4));
        wide_ = version >= kFirstWide;
        std::size_t at = kHeadBytes;
        while (true) {
            if (bytes_.size() - at < record_head())
                return fault("truncated", at, "the records end without their mark: send the file whole");
            if (number(at, field()) == 0) return models_.check(); // the mark; what follows is a footer
            if (Check bad = record(at, bytes_.size(), "", 0)) return bad;
        }
    }

private:
    static ImportFault fault(std::string code, std::size_t at, const std::string& what)
    {
        return {std::move(code), "byte " + std::to_string(at) + " of the FBX: " + what};
    }
    std::uint64_t number(std::size_t at, std::size_t size) const
    {
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i)
            value |= std::uint64_t(static_cast<unsigned char>(bytes_[at + i])) << (8 * i);
        return value;
    }
    std::size_t field() const { return wide_ ? 8 : 4; }
    std::size_t record_head() const { return 3 * field() + 1; }

    Check record(std::size_t& at, std::size_t end, std::string_view parent, int level);
    Check property(std::size_t& at, std::size_t end, Property& out) const;
    Check array(std::size_t& at, std::size_t end, Property& out) const;
    Check understand(std::string_view name,
                     std::string_view parent,
                     const std::vector<Property>& properties,
                     std::size_t at);
    Check indices(const Property& corners, std::size_t at) const;

    std::string_view bytes_;
    const Limits& limits_;
    bool wide_ = false;
    FbxModels models_;
    std::uint64_t vertices_ = 0, corners_ = 0; // of the geometry at hand; of all
};

Check BinaryFbx::array(std::size_t& at, std::size_t end, Property& out) const
{
    if (end - at < 12) return fault("truncated", at, "an array passes the end of its record");
    out.is_array = true;
    out.length = number(at, 4);
    const std::uint64_t encoding = number(at + 4, 4), stored = number(at + 8, 4),
                        bytes = out.length * element_bytes(out.type);
    const std::size_t where = at;
    at += 12;
    if (stored > end - at) return fault("truncated", where, "an array passes the end of its record");
    if (encoding > 1) return fault("malformed", where, "an array of unknown encoding");
    if (encoding == 0 ? bytes != stored : bytes > stored * kMostInflated)
        return fault("malformed",
                     where,
                     "an array promises " + std::to_string(out.length) + " values, which its " +
                         std::to_string(stored) + " bytes cannot hold");
    out.is_plain = encoding == 0;
    out.bytes = bytes_.substr(at, stored);
    at += stored;
    return std::nullopt;
}

Check BinaryFbx::property(std::size_t& at, std::size_t end, Property& out) const
{
    if (at >= end) return fault("truncated", at, "a record has fewer properties than it promises");
    out.type = bytes_[at++];
    if (const std::size_t size = scalar_bytes(out.type)) {
        if (size > end - at) return fault("truncated", at, "a property passes the end of its record");
        const std::uint64_t bits = number(at, size);
        out.number = out.type == 'I'   ? static_cast<std::int32_t>(bits)
                     : out.type == 'Y' ? static_cast<std::int16_t>(bits)
                                       : static_cast<std::int64_t>(bits);
        at += size;
        return std::nullopt;
    }
    if (element_bytes(out.type)) return array(at, end, out);
    if (out.type != 'S' && out.type != 'R') return fault("malformed", at - 1, "a property of unknown type");
    if (end - at < 4 || number(at, 4) > end - at - 4)
        return fault("truncated", at, "a text passes the end of its record");
    out.bytes = bytes_.substr(at + 4, number(at, 4));
    at += 4 + out.bytes.size();
    return std::nullopt;
}

Check BinaryFbx::indices(const Property& corners, std::size_t at) const
{
    if (corners.type != 'i' || !corners.is_plain) return std::nullopt; // a compressed one is for assimp
    for (std::uint64_t i = 0; i < corners.length; ++i) {
        std::int32_t index = 0;
        std::memcpy(&index, corners.bytes.data() + 4 * i, 4);
        const auto vertex =
            static_cast<std::uint32_t>(index < 0 ? ~index : index); // the last of a face is ~it
        if (vertex >= vertices_)
            return fault("index_out_of_range",
                         at,
                         "corner " + std::to_string(i) + " names vertex " + std::to_string(vertex) +
                             "; its geometry has " + std::to_string(vertices_));
    }
    return std::nullopt;
}

Check BinaryFbx::understand(std::string_view name,
                            std::string_view parent,
                            const std::vector<Property>& properties,
                            std::size_t at)
{
    if (parent == "Objects" && name == "Model" && !properties.empty())
        models_.add_model(properties[0].number);
    if (parent == "Connections" && name == "C" && properties.size() >= 3 && properties[0].bytes == "OO")
        models_.connect(properties[1].number, properties[2].number);
    if (parent == "Geometry" && name == "Vertices" && !properties.empty())
        vertices_ = properties[0].length / 3;
    if (parent == "Geometry" && name == "PolygonVertexIndex" && !properties.empty()) {
        corners_ += properties[0].length;
        if (corners_ / 3 > limits_.triangles && corners_ / 4 > limits_.triangles)
            return over_triangle_limit(corners_ / 4, limits_, true);
        return indices(properties[0], at);
    }
    return std::nullopt;
}

Check BinaryFbx::record(std::size_t& at, std::size_t end, std::string_view parent, int level)
{
    if (level > kDeepest) return fault("malformed", at, "records within records without end");
    const std::size_t begin = at;
    const std::uint64_t record_end = number(at, field()), count = number(at + field(), field()),
                        list_bytes = number(at + 2 * field(), field());
    const std::size_t name_bytes = static_cast<unsigned char>(bytes_[at + 3 * field()]);
    at += record_head();
    if (record_end > end)
        return fault("truncated",
                     begin,
                     "a record that ends at " + std::to_string(record_end) +
                         " passes the end of what holds it: send the file whole");
    if (record_end < at || name_bytes > record_end - at || list_bytes > record_end - at - name_bytes)
        return fault("malformed", begin, "a record is shorter than what it holds");
    const std::string_view name = bytes_.substr(at, name_bytes);
    at += name_bytes;
    const std::size_t list_end = at + list_bytes;
    if (count > list_bytes)
        return fault("malformed",
                     begin,
                     std::to_string(count) + " properties in " + std::to_string(list_bytes) + " bytes");
    std::vector<Property> properties;
    for (std::uint64_t i = 0; i < count; ++i)
        if (Check bad = property(at, list_end, properties.emplace_back())) return bad;
    if (at != list_end) return fault("malformed", at, "properties that are shorter than their record says");
    if (Check bad = understand(name, parent, properties, begin)) return bad;
    while (at < record_end) {
        if (record_end - at < record_head()) return fault("malformed", at, "a record ends without its mark");
        if (number(at, field()) == 0) {
            at = record_end;
            break;
        }
        if (Check bad = record(at, record_end, name, level + 1)) return bad;
    }
    return std::nullopt;
}

} // namespace

std::optional<ImportFault> check_binary_fbx(std::string_view bytes, const Limits& limits)
{
    return BinaryFbx(bytes, limits).run();
}

} // namespace renderer
