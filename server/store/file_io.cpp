#include "server/store/file_io.h"

#include "server/store/store.h"

#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace server {

void throw_io_error(const std::string& action, const std::filesystem::path& path, int error)
{
    const bool full = error == ENOSPC || error == EDQUOT;
    throw StoreError("cannot " + action + ' ' + path.string() + ": " + std::generic_category().message(error),
                     full);
}

void write_all(const FileDescriptor& file,
               std::span<const std::byte> bytes,
               const std::filesystem::path& path)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw_io_error("write", path, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void sync_file(const FileDescriptor& file, const std::filesystem::path& path)
{
    if (::fsync(file.get()) != 0) throw_io_error("sync", path, errno);
}

namespace {

FileDescriptor open_folder(const std::filesystem::path& folder)
{
    FileDescriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!fd) throw_io_error("open", folder, errno);
    return fd;
}

} // namespace

void sync_folder(const std::filesystem::path& folder)
{
    sync_file(open_folder(folder), folder);
}

void sync_file_system(const std::filesystem::path& folder)
{
    if (::syncfs(open_folder(folder).get()) != 0) throw_io_error("sync the file system of", folder, errno);
}

bool make_folder(const std::filesystem::path& folder)
{
    int error = ::mkdir(folder.c_str(), 0750) == 0 ? 0 : errno;
    if (error == ENOENT && folder.has_parent_path() && folder.parent_path() != folder) {
        make_folder(folder.parent_path());
        error =
            ::mkdir(folder.c_str(), 0750) == 0 ? 0 : errno; // in /proc still ENOENT: nothing is made there
    }
    if (error == 0) {
        sync_folder(folder.has_parent_path() ? folder.parent_path() : ".");
        return true;
    }
    if (error == EEXIST && std::filesystem::is_directory(folder)) return false;
    throw_io_error("make the folder", folder, error == EEXIST ? ENOTDIR : error);
}

} // namespace server
