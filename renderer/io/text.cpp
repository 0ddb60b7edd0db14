#include "renderer/io/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace renderer {

namespace {

// Bytes of the UTF-8 sequence that `text` starts with; 0 if it is none (overlong, surrogate, cut off).
std::size_t utf8_length(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0u) != 0x80u) return 0;
    const unsigned second = byte(1);
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f)) return 0;
    if ((first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f)) return 0;
    return length;
}

} // namespace

std::string_view take_word(std::string_view& line)
{
    std::size_t begin = 0;
    while (begin < line.size() && is_blank(line[begin]))
        ++begin;
    std::size_t end = begin;
    while (end < line.size() && !is_blank(line[end]))
        ++end;
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && is_blank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back()))
        text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text)
{
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

namespace {

bool is_digit(char c)
{
    return static_cast<unsigned char>(c - '0') < 10;
}

// The plain decimals that files are full of: up to 19 digits, a small exponent, no more than what is exact in
// double: then one division or product rounds once, and right (Clinger, "How to Read Floating Point Numbers
// Accurately", PLDI 1990). Sets `at` behind the number; false where the long way has to be gone.
bool quick_double(const char*& at, const char* end, double& value)
{
    static constexpr std::array<double, 23> kPowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                    1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                    1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    constexpr std::uint64_t kMostExact = 1ull << 53;
    const char* p = at;
    const bool negative = p < end && *p == '-';
    if (negative) ++p;
    std::uint64_t digits = 0;
    const char* const first = p;
    for (; p < end && is_digit(*p); ++p)
        digits = digits * 10 + static_cast<std::uint64_t>(*p - '0');
    std::ptrdiff_t count = p - first, places = 0;
    if (p < end && *p == '.') {
        const char* const point = ++p;
        for (; p < end && is_digit(*p); ++p)
            digits = digits * 10 + static_cast<std::uint64_t>(*p - '0');
        places = p - point;
        count += places;
    }
    if (count == 0 || count > 19 || digits > kMostExact) return false;
    std::ptrdiff_t exponent = -places;
    if (p < end && (*p == 'e' || *p == 'E')) {
        const char* q = p + 1;
        const bool below = q < end && *q == '-';
        if (q < end && (*q == '-' || *q == '+')) ++q;
        std::ptrdiff_t power = 0;
        const char* const power_first = q;
        for (; q < end && is_digit(*q) && power < 1000; ++q)
            power = power * 10 + (*q - '0');
        if (q == power_first) return false;
        exponent += below ? -power : power;
        p = q;
    }
    if (exponent < -22 || exponent > 22) return false;
    value = static_cast<double>(digits);
    value = exponent < 0 ? value / kPowers[static_cast<std::size_t>(-exponent)]
                         : value * kPowers[static_cast<std::size_t>(exponent)];
    if (negative) value = -value;
    at = p;
    return true;
}

// A double that was rounded right rounds on to the right float, unless it came to lie half way between two.
bool rounds_twice_alike(double value)
{
    constexpr std::uint64_t kLeftOut = (1ull << 29) - 1, kHalf = 1ull << 28;
    const double size = std::abs(value);
    return (std::bit_cast<std::uint64_t>(value) & kLeftOut) != kHalf &&
           (size == 0 || (size > 1e-37 && size < 1e38));
}

std::optional<float> parse_float_slowly(std::string_view word)
{
    if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
    const char* const end = word.data() + word.size();
    float value = 0;
    auto parsed = std::from_chars(word.data(), end, value);
    if (parsed.ec == std::errc() && parsed.ptr == end) return value;
    if (parsed.ec != std::errc::result_out_of_range || parsed.ptr != end) return std::nullopt;
    // from_chars does not tell too large from too small; double does for all but absurd exponents.
    double wide = 0;
    parsed = std::from_chars(word.data(), end, wide);
    const float sign = word.front() == '-' ? -1.0f : 1.0f;
    const float infinity = std::numeric_limits<float>::infinity();
    if (parsed.ec == std::errc())
        return std::abs(wide) > double(std::numeric_limits<float>::max()) ? sign * infinity
                                                                          : static_cast<float>(wide);
    return word.find("e-") != word.npos || word.find("E-") != word.npos ? sign * 0.0f : sign * infinity;
}

} // namespace

std::optional<float> parse_float(std::string_view word)
{
    const char* at = word.data();
    const char* const end = at + word.size();
    double value = 0;
    if (quick_double(at, end, value) && at == end && rounds_twice_alike(value))
        return static_cast<float>(value);
    return parse_float_slowly(word);
}

std::optional<std::int64_t> parse_integer(std::string_view word)
{
    if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
    const char* const end = word.data() + word.size();
    std::int64_t value = 0;
    const auto parsed = std::from_chars(word.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
    return value;
}

std::optional<float> take_float(std::string_view& line)
{
    const char* at = line.data();
    const char* const end = at + line.size();
    while (at < end && is_blank(*at))
        ++at;
    double value = 0;
    if (quick_double(at, end, value) && (at == end || is_blank(*at)) && rounds_twice_alike(value)) {
        line.remove_prefix(static_cast<std::size_t>(at - line.data()));
        return static_cast<float>(value);
    }
    return parse_float_slowly(take_word(line));
}

std::optional<Vec3f> take_vec3(std::string_view& line)
{
    const auto x = take_float(line), y = take_float(line), z = take_float(line);
    if (!x || !y || !z) return std::nullopt;
    return Vec3f{*x, *y, *z};
}

std::optional<double> parse_double(std::string_view word)
{
    const char* at = word.data();
    double value = 0;
    if (quick_double(at, word.data() + word.size(), value) && at == word.data() + word.size()) return value;
    if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
    const char* const end = word.data() + word.size();
    const auto parsed = std::from_chars(word.data(), end, value);
    if (parsed.ptr != end || parsed.ec == std::errc::invalid_argument) return std::nullopt;
    if (parsed.ec == std::errc()) return value;
    const bool small = word.find("e-") != word.npos || word.find("E-") != word.npos;
    return std::copysign(small ? 0 : std::numeric_limits<double>::infinity(), word.front() == '-' ? -1 : 1);
}

std::optional<Vec3d> take_point(std::string_view& line)
{
    Vec3d point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char* at = line.data();
        const char* const end = at + line.size();
        while (at < end && is_blank(*at))
            ++at;
        if (quick_double(at, end, point[axis]) && (at == end || is_blank(*at))) {
            line.remove_prefix(static_cast<std::size_t>(at - line.data()));
            continue;
        }
        const auto value = parse_double(take_word(line));
        if (!value) return std::nullopt;
        point[axis] = *value;
    }
    return point;
}

std::string_view Lines::take()
{
    const std::size_t end = rest_.find('\n');
    cut_off_ = end == rest_.npos;
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(cut_off_ ? rest_.size() : end + 1);
    ++following_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

std::optional<std::string_view> Lines::next()
{
    if (rest_.empty()) return std::nullopt;
    number_ = following_;
    std::string_view line = take();
    if (!join_ || line.empty() || line.back() != '\\') return line;
    joined_.clear();
    while (!line.empty() && line.back() == '\\' && !rest_.empty()) {
        joined_.append(line.substr(0, line.size() - 1)) += ' ';
        line = take();
    }
    return joined_.append(line);
}

std::uint64_t line_of(std::string_view text, std::size_t offset)
{
    const std::string_view before = text.substr(0, offset);
    return 1 + static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n'));
}

std::string in_quotes(std::string_view text)
{
    constexpr std::size_t kLongest = 40;
    std::string out(1, '"');
    out += clean_utf8(text, kLongest);
    return out += text.size() > kLongest ? "...\"" : "\"";
}

std::string clean_utf8(std::string_view text, std::size_t longest)
{
    std::string out;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const bool printable =
            length > 1 || (length == 1 && static_cast<unsigned char>(text[0]) >= 32 && text[0] != 127);
        const std::string_view piece = printable ? text.substr(0, length) : std::string_view("?");
        if (out.size() + piece.size() > longest) break;
        out += piece;
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return out;
}

} // namespace renderer
