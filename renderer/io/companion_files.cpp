#include "renderer/io/companion_files.h"

#include <algorithm>

namespace renderer {

bool is_plain_file_name(std::string_view name)
{
    constexpr std::size_t kLongestName = 1024;
    if (name.empty() || name.size() > kLongestName || name.front() == '/') return false;
    const auto forbidden = [](char c) { return c == '\\' || c == ':' || static_cast<unsigned char>(c) < 32; };
    if (std::any_of(name.begin(), name.end(), forbidden)) return false;
    for (std::size_t at = 0; at <= name.size();) {
        const std::size_t slash = std::min(name.find('/', at), name.size());
        if (name.substr(at, slash - at) == "..") return false;
        at = slash + 1;
    }
    return true;
}

std::optional<std::span<const std::byte>> CompanionFiles::open(std::string_view name)
{
    if (!open_ || !is_plain_file_name(name)) return std::nullopt;
    std::optional<std::span<const std::byte>> bytes = open_(name);
    if (!bytes && name.starts_with("./")) {
        name.remove_prefix(2);
        if (is_plain_file_name(name)) bytes = open_(name);
    }
    if (bytes) opened_.emplace(name);
    return bytes;
}

} // namespace renderer
