#include "renderer/io/gltf_buffers.h"

#include <array>
#include <cstdint>
#include <string>

namespace renderer {

namespace {

constexpr int kNoDigit = -1;

int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return kNoDigit;
}

int base64_digit(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : kNoDigit;
}

std::string without_percent(std::string_view uri)
{
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : kNoDigit;
        const int low = high == kNoDigit ? kNoDigit : hex_digit(uri[i + 2]);
        if (low == kNoDigit) {
            name += uri[i];
        } else {
            name += static_cast<char>(high * 16 + low);
            i += 2;
        }
    }
    return name;
}

} // namespace

std::optional<std::span<const std::byte>> open_uri(CompanionFiles& files, std::string_view uri)
{
    if (const auto bytes = files.open(uri)) return bytes;
    const std::string name = without_percent(uri);
    if (name == uri) return std::nullopt;
    return files.open(name);
}

std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri)
{
    const std::size_t comma = uri.find(',');
    if (!uri.starts_with("data:") || comma == uri.npos || !uri.substr(0, comma).ends_with(";base64"))
        return std::nullopt;
    std::string_view text = uri.substr(comma + 1);
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding)
        text.remove_suffix(1);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit == kNoDigit) {
            if (c == '\\') continue; // JSON's escape of the slash that follows
            return std::nullopt;
        }
        bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes.push_back(static_cast<std::byte>((bits >> held) & 0xff));
    }
    return bytes;
}

} // namespace renderer
