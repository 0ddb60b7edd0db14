#include "clients/cli/files.h"

#include "clients/cli/user_error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <unistd.h>

namespace clients {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenedFile = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(const char* what, const std::filesystem::path& path, int error)
{
    throw UserError(ExitCode::usage,
                    std::string(what) + ' ' + path.string() + ": " + std::generic_category().message(error));
}

std::string read_all(std::FILE* file, const std::filesystem::path& path)
{
    std::string bytes;
    std::array<char, 1 << 16> chunk;
    while (const std::size_t count = std::fread(chunk.data(), 1, chunk.size(), file))
        bytes.append(chunk.data(), count);
    if (std::ferror(file) != 0) fail("cannot read", path, errno);
    return bytes;
}

void write_all(std::FILE* file, std::string_view bytes, const std::filesystem::path& path)
{
    if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fflush(file) != 0)
        fail("cannot write", path, errno);
}

// A device or a pipe cannot be replaced, only written to; nor may the name of a descriptor be, which
// /dev/stdout is, whatever it stands for.
bool is_written_in_place(const std::filesystem::path& path)
{
    std::error_code error;
    std::filesystem::path name = path;
    for (int links = 0; links < 40 && std::filesystem::is_symlink(name, error); ++links) {
        const auto folder = std::filesystem::canonical(std::filesystem::absolute(name).parent_path(), error);
        if (folder.string().starts_with("/proc/")) return true;
        name = name.parent_path() / std::filesystem::read_symlink(name, error);
    }
    return std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error);
}

} // namespace

std::string read_file(const std::filesystem::path& path)
{
    if (path == "-") return read_all(stdin, "standard input");
    auto bytes = read_file_if_there(path);
    if (!bytes) fail("cannot read", path, ENOENT);
    return *std::move(bytes);
}

std::optional<std::string> read_file_if_there(const std::filesystem::path& path)
{
    const OpenedFile file(std::fopen(path.c_str(), "rb"));
    if (!file) {
        if (errno == ENOENT || errno == ENOTDIR) return std::nullopt;
        fail("cannot read", path, errno);
    }
    return read_all(file.get(), path);
}

void write_file(const std::filesystem::path& path, std::string_view bytes)
{
    if (path == "-") return write_all(stdout, bytes, "standard output");
    std::error_code error;
    if (is_written_in_place(path)) {
        const OpenedFile file(std::fopen(path.c_str(), "wb"));
        if (!file) fail("cannot write", path, errno);
        return write_all(file.get(), bytes, path);
    }
    const std::filesystem::path partial = path.string() + ".part" + std::to_string(::getpid());
    {
        const OpenedFile file(std::fopen(partial.c_str(), "wbx"));
        if (!file) fail("cannot write", partial, errno);
        try {
            write_all(file.get(), bytes, partial);
        } catch (...) {
            std::filesystem::remove(partial, error);
            throw;
        }
    }
    std::filesystem::rename(partial, path, error);
    if (error) {
        const int reason = error.value();
        std::filesystem::remove(partial, error);
        fail("cannot write", path, reason);
    }
}

void check_writable(const std::filesystem::path& path)
{
    if (path == "-") return;
    if (std::filesystem::is_directory(path)) fail("cannot write", path, EISDIR);
    if (is_written_in_place(path)) {
        if (::access(path.c_str(), W_OK) != 0) fail("cannot write", path, errno);
        return;
    }
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail("cannot write to the folder", folder, errno);
}

std::string lower_extension(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return extension;
}

} // namespace clients
