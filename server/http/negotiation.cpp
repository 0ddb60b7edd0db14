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

// The q of a range in thousandths; 1000 where there is none, or none that can be read.
int quality_of(const std::vector<std::string_view>& range)
{
    for (std::size_t i = 1; i < range.size(); ++i) {
        const std::string low = lower(range[i]);
        if (low.rfind("q=", 0) != 0) continue;
        const std::string_view value = std::string_view(low).substr(2);
        if (value.empty() || value.size() > 5 || (value[0] != '0' && value[0] != '1')) return 1000;
        if (value.size() > 1 && value[1] != '.') return 1000;
        int thousandths = (value[0] - '0') * 1000, digit = 1000;
        for (const char c : value.substr(std::min<std::size_t>(value.size(), 2))) {
            if (c < '0' || c > '9') return 1000;
            digit /= 10;
            thousandths += (c - '0') * digit;
        }
        return std::min(thousandths, 1000);
    }
    return 1000;
}

// How exactly a range names a type; 0: not at all.
int exactness(std::string_view range, std::string_view type)
{
    if (range == type) return 3;
    if (range == "image/*") return 2;
    return range == "*/*" || range == "*" ? 1 : 0;
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

std::optional<renderer::PictureFormat> Acceptance::best() const
{
    const auto most = std::max_element(quality.begin(), quality.end());
    if (*most == 0) return std::nullopt;
    return renderer::kPictureFormats[static_cast<std::size_t>(most - quality.begin())].format;
}

std::optional<renderer::PictureFormat> Acceptance::best_of(renderer::Layer layer) const
{
    using renderer::PictureFormat;
    std::optional<PictureFormat> best;
    for (const PictureFormat format : {PictureFormat::exr, PictureFormat::pfm, PictureFormat::png}) {
        if (!holds(format, layer) || !takes(format)) continue;
        const auto quality_of = [&](PictureFormat f) { return quality[static_cast<std::size_t>(f)]; };
        if (!best || quality_of(format) > quality_of(*best)) best = format;
    }
    return best;
}

Acceptance read_accept(const std::string& accept)
{
    Acceptance found;
    if (trimmed(accept).empty()) {
        found.quality.fill(1000);
        return found;
    }
    found.only_images = true;
    std::array<int, renderer::kPictureFormats.size()> exact{};
    for (const std::string_view item : split(accept, ',')) {
        if (item.empty()) continue;
        const std::vector<std::string_view> range = split(item, ';');
        const std::string type = lower(range.front());
        const int quality = quality_of(range);
        if (quality != 0 && type.rfind("image/", 0) != 0) found.only_images = false;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            const int how = exactness(type, renderer::kPictureFormats[i].media_type);
            if (how == 0 || how < exact[i]) continue;
            found.quality[i] = how > exact[i] ? quality : std::max(found.quality[i], quality);
            exact[i] = how;
        }
    }
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
