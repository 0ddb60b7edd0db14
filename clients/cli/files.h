// Files: reading whole ones, writing them so that nobody sees half of one.
//
// Errors  UserError(usage) with the path and the system's reason.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace clients {

// "-" reads standard input.
std::string read_file(const std::filesystem::path& path);
// Nothing if there is no such file; an error if it is there but cannot be read.
std::optional<std::string> read_file_if_there(const std::filesystem::path& path);

// Writes a file beside `path` and renames it; "-" writes to standard output, and what is no regular file is
// written to as it is.
void write_file(const std::filesystem::path& path, std::string_view bytes);
// Fails now rather than after the render: the folder of `path` must be there and take files, a device or
// pipe must be writable itself.
void check_writable(const std::filesystem::path& path);

// The extension with its dot, in small letters: ".png".
std::string lower_extension(const std::filesystem::path& path);

} // namespace clients
