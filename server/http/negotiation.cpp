#include "server/http/negotiation.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>
#include <vector>

namespace server {

namespace {

std::string lower(std::string_view text)
{
    std::string low(text);
    std::transform(low.begin(), low.end(), low.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return low;
}

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t'))
        text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t'))
        text.remove_suffix(1);
    return text;
}

// Where `separator` stands outside quotes, or the end.
std::size_t find_separator(std::string_view text, char separator)
{
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '"') quoted = !quoted;
        if (text[i] == '\\' && quoted) ++i;
        if (i < text.size() && text[i] == separator && !quoted) return i;
    }
    return text.size();
}

std::vector<std::string_view> split(std::string_view text, char separator)
{
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t end = find_separator(text, separator);
        parts.push_back(trimmed(text.substr(0, end)));
        if (end == text.size()) return parts;
        text.remove_prefix(end + 1);
    }
}

// A word is a token or a quoted string (RFC 9110, 5.6.4).
std::string unquoted(std::string_view word)
{
    if (word.size() < 2 || word.front() != '"' || word.back() != '"') return std::string(word);
    std::string text;
    for (std::size_t i = 1; i + 1 < word.size(); ++i) {
        if (word[i] == '\\' && i + 2 < word.size()) ++i;
        text += word[i];
    }
    return text;
}

// q=0, q=0.0 ...: "not this one".
bool is_refused(const std::vector<std::string_view>& range)
{
    return std::any_of(range.begin() + 1, range.end(), [](std::string_view parameter) {
        const std::string low = lower(parameter);
        return low.rfind("q=0", 0) == 0 && low.find_first_not_of("0.", 2) == std::string::npos;
    });
}

} // namespace

std::optional<std::uint64_t> preferred_wait_s(const std::string& prefer)
{
    for (const std::string_view preference : split(prefer, ',')) {
        const std::vector<std::string_view> parts = split(split(preference, ';').front(), '=');
        if (lower(parts.front()) != "wait") continue;
        if (parts.size() != 2) return std::nullopt;
        const std::string digits = unquoted(parts[1]);
        std::uint64_t seconds = 0;
        const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
        if (error == std::errc::result_out_of_range) return UINT64_MAX;
        if (digits.empty() || error != std::errc() || stop != digits.data() + digits.size())
            return std::nullopt;
        return seconds;
    }
    return std::nullopt;
}

Acceptance read_accept(const std::string& accept)
{
    if (trimmed(accept).empty()) return {};
    Acceptance found{true, false};
    bool png_refused = false;
    for (const std::string_view item : split(accept, ',')) {
        if (item.empty()) continue;
        const std::vector<std::string_view> range = split(item, ';');
        const std::string type = lower(range.front());
        if (is_refused(range)) {
            png_refused = png_refused || type == "image/png";
            continue;
        }
        if (type.rfind("image/", 0) != 0) found.only_images = false;
        if (type == "image/png" || type == "image/*" || type == "*/*" || type == "*") found.png = true;
    }
    found.png = found.png && !png_refused;
    return found;
}

bool wants_fresh(const std::string& cache_control)
{
    const auto directives = split(cache_control, ',');
    return std::any_of(directives.begin(), directives.end(), [](std::string_view directive) {
        return lower(directive) == "no-cache";
    });
}

} // namespace server
