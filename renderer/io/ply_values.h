// PlyValues: the numbers after a PLY header, one after the other, whatever their encoding.
//
// Errors  next() gives nothing where the data ends or (ASCII) where a word is no number; ended() tells which.
#pragma once

#include "renderer/io/ply_header.h"
#include "renderer/io/text.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace renderer {

class PlyValues {
public:
    PlyValues(std::string_view file, const PlyHeader& header)
        : file_(file), at_(header.size_bytes), ascii_(header.encoding == PlyHeader::Encoding::ascii),
          swap_((header.encoding == PlyHeader::Encoding::big_endian) ==
                (std::endian::native == std::endian::little))
    {
    }

    std::optional<double> next(PlyType type) { return ascii_ ? next_word() : next_binary(type); }
    std::size_t bytes_left() const { return file_.size() - at_; }
    // Where the next values stand as this machine would have them, for who decodes many of one kind at once;
    // null where they do not.
    const char* as_they_stand() const { return ascii_ || swap_ ? nullptr : file_.data() + at_; }
    void skip_bytes(std::size_t count) { at_ += count; } // no more than are left
    bool ended() const { return ended_; }
    bool only_blanks_left() const { return file_.find_first_not_of(" \t\r\n", at_) == file_.npos; }
    // "line 12" or "byte 4711", of the next value.
    std::string place() const
    {
        return ascii_ ? "line " + std::to_string(line_of(file_, at_)) : "byte " + std::to_string(at_);
    }

private:
    std::optional<double> next_word()
    {
        const auto is_gap = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
        while (at_ < file_.size() && is_gap(file_[at_]))
            ++at_;
        std::size_t end = at_;
        while (end < file_.size() && !is_gap(file_[end]))
            ++end;
        ended_ = at_ == file_.size();
        const auto value = parse_float(file_.substr(at_, end - at_));
        if (!value) return std::nullopt;
        // Indices beyond 2^24 do not fit a float.
        const auto whole = parse_integer(file_.substr(at_, end - at_));
        at_ = end;
        return whole ? static_cast<double>(*whole) : static_cast<double>(*value);
    }

    template <typename T, typename Bits>
    double decode() const
    {
        Bits bits;
        std::memcpy(&bits, file_.data() + at_, sizeof bits);
        if (swap_) {
            Bits reversed = 0;
            for (std::size_t i = 0; i < sizeof bits; ++i)
                reversed = static_cast<Bits>(Bits(reversed << 8) | Bits((bits >> (8 * i)) & 0xff));
            bits = reversed;
        }
        return static_cast<double>(std::bit_cast<T>(bits));
    }

    std::optional<double> next_binary(PlyType type)
    {
        const std::size_t size = size_of(type);
        ended_ = bytes_left() < size;
        if (ended_) return std::nullopt;
        const double value = decode(type);
        at_ += size;
        return value;
    }

    double decode(PlyType type) const
    {
        switch (type) {
        case PlyType::int8:
            return static_cast<signed char>(file_[at_]);
        case PlyType::uint8:
            return static_cast<unsigned char>(file_[at_]);
        case PlyType::int16:
            return decode<std::int16_t, std::uint16_t>();
        case PlyType::uint16:
            return decode<std::uint16_t, std::uint16_t>();
        case PlyType::int32:
            return decode<std::int32_t, std::uint32_t>();
        case PlyType::uint32:
            return decode<std::uint32_t, std::uint32_t>();
        case PlyType::float32:
            return decode<float, std::uint32_t>();
        case PlyType::float64:
            return decode<double, std::uint64_t>();
        }
        return 0;
    }

    std::string_view file_;
    std::size_t at_;
    bool ascii_, swap_, ended_ = false;
};

} // namespace renderer
