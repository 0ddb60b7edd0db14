// ByteRange: what a Range header asks of a payload. One range is served; several are answered with the whole,
// as RFC 9110 allows, since a thousand overlapping ones would multiply a small request into gigabytes.
#pragma once

#include <cstdint>
#include <string>

namespace server {

struct ByteRange {
    enum class Kind : std::uint8_t { whole, part, beyond };
    Kind kind = Kind::whole;
    std::uint64_t first = 0, count = 0; // of a part
};

// A header that is empty, in another unit or malformed asks for the whole.
ByteRange read_byte_range(const std::string& header, std::uint64_t size);

} // namespace server
