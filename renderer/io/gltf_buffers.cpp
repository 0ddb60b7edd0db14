#include "renderer/io/gltf_buffers.h"

#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace renderer {

namespace {

using Bytes = std::span<const std::byte>;
using Check = std::optional<ImportFault>;

std::uint32_t component_bytes(std::uint32_t type)
{
    switch (type) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

std::uint32_t components(std::string_view type)
{
    constexpr std::array<std::pair<std::string_view, std::uint32_t>, 7> kTypes{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
    for (const auto& [name, count] : kTypes)
        if (name == type) return count;
    return 0;
}

ImportFault malformed(std::string_view what, std::size_t number, const std::string& why)
{
    return {"malformed", std::string(what) + " " + std::to_string(number) + " of the glTF " + why};
}

class BufferCheck {
public:
    BufferCheck(const GltfOutline& outline, CompanionFiles& files, const Limits& limits)
        : outline_(outline), files_(files), limits_(limits)
    {
    }
    Check run(std::optional<Bytes> binary)
    {
        for (std::size_t i = 0; i < outline_.buffers.size(); ++i)
            if (Check bad = buffer(i, binary)) return bad;
        for (std::size_t i = 0; i < outline_.views.size(); ++i)
            if (Check bad = view(i)) return bad;
        for (std::size_t i = 0; i < outline_.accessors.size(); ++i)
            if (Check bad = accessor(i)) return bad;
        largest_.resize(outline_.accessors.size());
        for (const GltfPrimitive& p : outline_.primitives)
            if (Check bad = primitive(p)) return bad;
        return std::nullopt;
    }

private:
    Check buffer(std::size_t number, std::optional<Bytes> binary);
    Check view(std::size_t number) const;
    Check accessor(std::size_t number) const;
    Check primitive(const GltfPrimitive& p);
    Check indices(const GltfPrimitive& p, std::uint32_t vertices);
    std::uint32_t largest_index(std::uint32_t accessor);

    const GltfOutline& outline_;
    CompanionFiles& files_;
    const Limits& limits_;
    std::vector<std::vector<std::byte>> decoded_;
    std::vector<Bytes> buffers_;
    std::vector<std::optional<std::uint32_t>> largest_; // of the indices in an accessor, once known
    std::uint64_t triangles_ = 0;
};

Check BufferCheck::buffer(std::size_t number, std::optional<Bytes> binary)
{
    const GltfBuffer& b = outline_.buffers[number];
    std::optional<Bytes> bytes = binary;
    if (b.uri && b.uri->starts_with("data:")) {
        auto decoded = decode_data_uri(*b.uri);
        if (!decoded) return malformed("buffer", number, "has a data: URI that is not base64");
        bytes = decoded_.emplace_back(std::move(*decoded));
    } else if (b.uri) {
        bytes = open_uri(files_, *b.uri);
        if (!bytes)
            return ImportFault{"missing_file",
                               "the glTF names " + in_quotes(*b.uri) +
                                   ", which did not come with it: a job names it in its files"};
    } else if (number != 0 || !binary) {
        return malformed("buffer", number, "has no uri, and there is no binary chunk for it");
    }
    if (bytes->size() < b.length)
        return ImportFault{"truncated",
                           "buffer " + std::to_string(number) + " of the glTF promises " +
                               std::to_string(b.length) + " bytes and has " + std::to_string(bytes->size()) +
                               ": send it whole"};
    buffers_.push_back(bytes->first(b.length));
    return std::nullopt;
}

Check BufferCheck::view(std::size_t number) const
{
    const GltfView& v = outline_.views[number];
    if (v.buffer >= buffers_.size())
        return malformed("bufferView", number, "names a buffer that is not there");
    if (std::uint64_t(v.offset) + v.length > buffers_[v.buffer].size())
        return malformed("bufferView", number, "passes the end of its buffer");
    return std::nullopt;
}

Check BufferCheck::accessor(std::size_t number) const
{
    const GltfAccessor& a = outline_.accessors[number];
    if (a.sparse || !a.view)
        return ImportFault{"unsupported",
                           "accessor " + std::to_string(number) +
                               " of the glTF is sparse or has no bufferView: "
                               "export without sparse accessors"};
    if (*a.view >= outline_.views.size())
        return malformed("accessor", number, "names a bufferView that is not there");
    const GltfView& v = outline_.views[*a.view];
    const std::uint64_t element = std::uint64_t(component_bytes(a.component_type)) * components(a.type);
    if (element == 0) return malformed("accessor", number, "has an unknown type");
    if (v.stride && v.stride < element) return malformed("accessor", number, "has elements that overlap");
    const std::uint64_t stride = v.stride ? v.stride : element;
    if (a.count && a.offset + (a.count - 1) * stride + element > v.length)
        return malformed("accessor",
                         number,
                         "of " + std::to_string(a.count) + " elements passes the end of its bufferView");
    return std::nullopt;
}

std::uint32_t BufferCheck::largest_index(std::uint32_t number)
{
    if (largest_[number]) return *largest_[number];
    const GltfAccessor& a = outline_.accessors[number];
    const GltfView& v = outline_.views[*a.view];
    const std::uint32_t size = component_bytes(a.component_type);
    const std::byte* at = buffers_[v.buffer].data() + v.offset + a.offset;
    std::uint32_t largest = 0;
    for (std::uint32_t i = 0; i < a.count; ++i, at += v.stride ? v.stride : size) {
        std::uint32_t index = 0;
        for (std::uint32_t byte = 0; byte < size; ++byte)
            index |= std::to_integer<std::uint32_t>(at[byte]) << (8 * byte);
        largest = std::max(largest, index);
    }
    largest_[number] = largest;
    return largest;
}

Check BufferCheck::indices(const GltfPrimitive& p, std::uint32_t vertices)
{
    if (*p.indices >= outline_.accessors.size())
        return malformed("mesh", p.mesh, "has indices in an accessor that is not there");
    const GltfAccessor& a = outline_.accessors[*p.indices];
    if (a.type != "SCALAR" ||
        (a.component_type != 5121 && a.component_type != 5123 && a.component_type != 5125))
        return malformed("mesh", p.mesh, "has indices that are no whole numbers");
    if (a.count && largest_index(*p.indices) >= vertices)
        return ImportFault{"index_out_of_range",
                           "mesh " + std::to_string(p.mesh) + " of the glTF names vertex " +
                               std::to_string(largest_index(*p.indices)) + "; it has " +
                               std::to_string(vertices)};
    return std::nullopt;
}

Check BufferCheck::primitive(const GltfPrimitive& p)
{
    if (p.mode > 6) return malformed("mesh", p.mesh, "has a primitive of an unknown mode");
    if (!p.positions) return malformed("mesh", p.mesh, "has a primitive without POSITION");
    for (const std::uint32_t attribute : p.attributes)
        if (attribute >= outline_.accessors.size())
            return malformed("mesh", p.mesh, "names an accessor that is not there");
    const GltfAccessor& positions = outline_.accessors[*p.positions];
    if (positions.type != "VEC3" || positions.component_type != 5126)
        return malformed("mesh", p.mesh, "has positions that are not three floats");
    for (const std::uint32_t attribute : p.attributes)
        if (outline_.accessors[attribute].count != positions.count)
            return malformed("mesh", p.mesh, "has attributes of different counts");
    if (p.indices)
        if (Check bad = indices(p, positions.count)) return bad;
    const std::uint64_t corners = p.indices ? outline_.accessors[*p.indices].count : positions.count;
    if (p.mode == 4 && corners % 3)
        return malformed(
            "mesh", p.mesh, "has " + std::to_string(corners) + " corners of triangles, not three each");
    triangles_ += p.mode < 4 ? 0 : p.mode == 4 ? corners / 3 : corners - std::min<std::uint64_t>(corners, 2);
    if (triangles_ > limits_.triangles) return over_triangle_limit(triangles_, limits_, true);
    return over_output_limit(0, triangles_, limits_);
}

} // namespace

std::optional<ImportFault> check_gltf_buffers(const GltfOutline& outline,
                                              std::optional<Bytes> binary,
                                              CompanionFiles& files,
                                              const Limits& limits)
{
    return BufferCheck(outline, files, limits).run(binary);
}

} // namespace renderer
