// PlyHeader: the head of a PLY file: which elements follow, how many of each, in which types and byte order.
//
// Source  Turk, "The PLY Polygon File Format", 1994.
#pragma once

#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace renderer {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(PlyType type)
{
    constexpr std::size_t kSizes[]{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8; // of a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    // Fewest bytes that one takes: lists empty; in ASCII a digit and a blank a number.
    std::uint64_t least_bytes(bool ascii) const;
};

struct PlyHeader {
    enum class Encoding : std::uint8_t { ascii, little_endian, big_endian };
    Encoding encoding = Encoding::ascii;
    std::vector<PlyElement> elements;
    std::size_t size_bytes = 0; // the data starts here
};

std::variant<PlyHeader, ImportFault> read_ply_header(std::string_view text);

} // namespace renderer
