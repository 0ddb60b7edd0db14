// Words and numbers of text formats (OBJ, MTL, ASCII PLY and STL), without locale or exceptions; what returns a
// view or a number allocates nothing.
#pragma once

#include "renderer/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace renderer {

inline std::string_view text_of(std::span<const std::byte> bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

constexpr bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// Takes the next word off `line`; empty at its end.
std::string_view take_word(std::string_view& line);
std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

// A whole word as a number; nothing if it is none. Too large becomes infinite, too small zero; "nan" and
// "inf" are numbers here: whoever uses them says so.
std::optional<float> parse_float(std::string_view word);
std::optional<std::int64_t> parse_integer(std::string_view word);

// Takes one number (three of them) off `line`; nothing if the next word is none.
std::optional<float> take_float(std::string_view& line);
std::optional<Vec3f> take_vec3(std::string_view& line);
// The same in double, for places: meshes far from the origin need more digits than a float has.
std::optional<double> parse_double(std::string_view word);
std::optional<Vec3d> take_point(std::string_view& line);

// Lines one after the other, counted from 1; a backslash at the end of a line joins the next one to it if
// asked for.
class Lines {
public:
    explicit Lines(std::string_view text, bool join_backslash = false) : rest_(text), join_(join_backslash) {}
    // The next line without its end; nothing after the last.
    std::optional<std::string_view> next();
    std::uint64_t number() const { return number_; } // of the line that next() gave (its first, if joined)
    bool cut_off() const { return cut_off_; } // that line had no newline: the text ends within or after it

private:
    std::string_view take();
    std::string_view rest_;
    std::string joined_;
    std::uint64_t number_ = 0, following_ = 1;
    bool join_ = false, cut_off_ = false;
};

std::uint64_t line_of(std::string_view text, std::size_t offset); // counted from 1
std::string in_quotes(std::string_view text);                     // for messages: bounded, printable

// The text with what is not UTF-8 (or a control character) replaced, at most `longest` bytes.
std::string clean_utf8(std::string_view text, std::size_t longest = 256);

} // namespace renderer
