#include "renderer/io/json_scan.h"

#include "renderer/io/text.h"

#include <limits>

namespace renderer {

namespace {

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

} // namespace

void JsonScan::blanks()
{
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r' || text_[at_] == '\t'))
        ++at_;
}

bool JsonScan::peek(char c)
{
    blanks();
    return at_ < text_.size() && text_[at_] == c;
}

bool JsonScan::take(char c)
{
    if (!peek(c)) return false;
    ++at_;
    return true;
}

bool JsonScan::enter()
{
    too_deep_ = too_deep_ || levels_left_ <= 0;
    if (too_deep_) return false;
    --levels_left_;
    return true;
}

bool JsonScan::string(std::string_view& out)
{
    if (!take('"')) return false;
    const std::size_t begin = at_;
    for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
        if (static_cast<unsigned char>(text_[at_]) < 32) return false;
        if (text_[at_] == '\\' && ++at_ == text_.size()) return false;
    }
    if (at_ >= text_.size()) return false;
    out = text_.substr(begin, at_ - begin);
    ++at_;
    return true;
}

bool JsonScan::object(const std::function<bool(std::string_view)>& member)
{
    if (!take('{') || !enter()) return false;
    if (!peek('}')) {
        do {
            std::string_view key;
            if (!string(key) || !take(':')) return false;
            if (key.find('\\') != key.npos) key = {};
            if (!member(key)) return false;
        } while (take(','));
    }
    ++levels_left_;
    return take('}');
}

bool JsonScan::array(const std::function<bool()>& element)
{
    if (!take('[') || !enter()) return false;
    if (!peek(']')) {
        do {
            if (!element()) return false;
        } while (take(','));
    }
    ++levels_left_;
    return take(']');
}

bool JsonScan::number()
{
    const auto digits = [&] {
        const std::size_t begin = at_;
        while (at_ < text_.size() && is_digit(text_[at_]))
            ++at_;
        return at_ > begin;
    };
    const auto next_is = [&](std::string_view any) {
        return at_ < text_.size() && any.find(text_[at_]) != any.npos;
    };
    if (next_is("-")) ++at_;
    const std::size_t first = at_;
    if (!digits() || (text_[first] == '0' && at_ > first + 1)) return false;
    if (next_is(".") && (++at_, !digits())) return false;
    if (next_is("eE")) {
        ++at_;
        if (next_is("+-")) ++at_;
        return digits();
    }
    return true;
}

bool JsonScan::index(std::uint32_t& out)
{
    blanks();
    const std::size_t begin = at_;
    if (!number()) return false;
    const auto value = parse_integer(text_.substr(begin, at_ - begin));
    const bool good = value && *value >= 0 && *value <= std::numeric_limits<std::uint32_t>::max();
    if (good)
        out = static_cast<std::uint32_t>(*value);
    else
        at_ = begin;
    return good;
}

bool JsonScan::word(std::string_view expected)
{
    if (!text_.substr(at_).starts_with(expected)) return false;
    at_ += expected.size();
    return true;
}

bool JsonScan::skip()
{
    blanks();
    if (at_ >= text_.size()) return false;
    switch (text_[at_]) {
    case '{':
        return object([this](std::string_view) { return skip(); });
    case '[':
        return array([this] { return skip(); });
    case 't':
        return word("true");
    case 'f':
        return word("false");
    case 'n':
        return word("null");
    case '"': {
        std::string_view ignored;
        return string(ignored);
    }
    default:
        return number();
    }
}

bool JsonScan::at_end()
{
    blanks();
    return at_ == text_.size();
}

} // namespace renderer
