#include "server/http/byte_range.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace server {

namespace {

std::optional<std::uint64_t> read_number(std::string_view text)
{
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
    return value;
}

} // namespace

ByteRange read_byte_range(const std::string& header, std::uint64_t size)
{
    std::string_view text = header;
    if (text.substr(0, 6) != "bytes=" || text.find(',') != std::string_view::npos) return {};
    text.remove_prefix(6);
    const std::size_t dash = text.find('-');
    if (dash == std::string_view::npos) return {};
    const auto first = read_number(text.substr(0, dash)), last = read_number(text.substr(dash + 1));
    if (dash == 0) { // the last so many bytes
        if (!last) return {};
        const std::uint64_t count = std::min(*last, size);
        if (count == 0) return {ByteRange::Kind::beyond};
        return {ByteRange::Kind::part, size - count, count};
    }
    const bool open = dash + 1 == text.size();
    if (!first || (!open && (!last || *last < *first))) return {};
    if (*first >= size) return {ByteRange::Kind::beyond};
    const std::uint64_t end = open ? size : std::min(*last, size - 1) + 1;
    return {ByteRange::Kind::part, *first, end - *first};
}

} // namespace server
