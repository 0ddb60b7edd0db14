#include "renderer/io/ply_header.h"

#include "renderer/io/text.h"

#include <array>
#include <optional>
#include <utility>

namespace renderer {

namespace {

std::optional<PlyType> type_of(std::string_view word)
{
    constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                     {"uchar", "uint8"},
                                                                     {"short", "int16"},
                                                                     {"ushort", "uint16"},
                                                                     {"int", "int32"},
                                                                     {"uint", "uint32"},
                                                                     {"float", "float32"},
                                                                     {"double", "float64"}}};
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<PlyType>(i);
    return std::nullopt;
}

bool is_whole(PlyType type)
{
    return type < PlyType::float32;
}

bool take_encoding(std::string_view rest, PlyHeader& header)
{
    const std::string_view name = take_word(rest);
    if (name == "ascii")
        header.encoding = PlyHeader::Encoding::ascii;
    else if (name == "binary_little_endian")
        header.encoding = PlyHeader::Encoding::little_endian;
    else if (name == "binary_big_endian")
        header.encoding = PlyHeader::Encoding::big_endian;
    else
        return false;
    return trimmed(rest) == "1.0";
}

bool take_element(std::string_view rest, PlyHeader& header)
{
    const std::string_view name = take_word(rest);
    const auto count = parse_integer(trimmed(rest));
    if (name.empty() || !count || *count < 0) return false;
    header.elements.push_back({std::string(name), static_cast<std::uint64_t>(*count), {}});
    return true;
}

bool take_property(std::string_view rest, PlyHeader& header)
{
    if (header.elements.empty()) return false;
    PlyProperty property;
    std::string_view word = take_word(rest);
    property.is_list = word == "list";
    if (property.is_list) {
        const auto count_type = type_of(take_word(rest));
        if (!count_type || !is_whole(*count_type)) return false;
        property.count_type = *count_type;
        word = take_word(rest);
    }
    const auto type = type_of(word);
    property.name = trimmed(rest);
    if (!type || property.name.empty()) return false;
    property.type = *type;
    header.elements.back().properties.push_back(std::move(property));
    return true;
}

} // namespace

std::uint64_t PlyElement::least_bytes(bool ascii) const
{
    std::uint64_t bytes = 0;
    for (const PlyProperty& p : properties)
        bytes += ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
    return bytes;
}

std::variant<PlyHeader, ImportFault> read_ply_header(std::string_view text)
{
    constexpr std::size_t kMostLines = 4096; // bounds elements and properties
    PlyHeader header;
    bool has_format = false;
    Lines lines(text);
    while (const auto line = lines.next()) {
        const auto fault = [&](const std::string& what) {
            return ImportFault{"malformed",
                               "line " + std::to_string(lines.number()) + " of the PLY header: " + what};
        };
        if (lines.cut_off()) break;
        std::string_view rest = *line;
        const std::string_view word = take_word(rest);
        if (lines.number() == 1 && word == "ply") continue;
        if (lines.number() > kMostLines) return fault("no end_header in sight");
        if (word == "end_header") {
            if (!has_format) return fault("there is no line \"format ... 1.0\" before it");
            header.size_bytes = static_cast<std::size_t>(line->data() - text.data()) + line->size();
            header.size_bytes = text.find('\n', header.size_bytes) + 1;
            return header;
        }
        if (word.empty() || word == "comment" || word == "obj_info") continue;
        bool good = false;
        if (word == "format")
            good = has_format = take_encoding(rest, header);
        else if (word == "element")
            good = take_element(rest, header);
        else if (word == "property")
            good = take_property(rest, header);
        if (!good) return fault(in_quotes(trimmed(*line)) + " is not understood");
    }
    return ImportFault{"truncated", "the PLY header ends without end_header: send the file whole"};
}

} // namespace renderer
