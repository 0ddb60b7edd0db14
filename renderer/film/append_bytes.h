// Numbers and texts at the end of a file's bytes, little-endian as EXR and PFM want them.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>
#include <vector>

namespace renderer {

using Bytes = std::vector<std::uint8_t>;

inline void append_text(Bytes& bytes, std::string_view text)
{
    bytes.insert(bytes.end(), text.begin(), text.end());
}

inline void append_u32(Bytes& bytes, std::uint32_t value)
{
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

inline void append_u64(Bytes& bytes, std::uint64_t value)
{
    append_u32(bytes, static_cast<std::uint32_t>(value));
    append_u32(bytes, static_cast<std::uint32_t>(value >> 32));
}

inline void append_float(Bytes& bytes, float value)
{
    append_u32(bytes, std::bit_cast<std::uint32_t>(value));
}

} // namespace renderer
