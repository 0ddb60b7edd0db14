#include "server/store/blob_folder.h"

#include "server/store/blob_store.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace server {

namespace {

constexpr std::string_view kTemporaryPrefix = "incoming-";
constexpr std::string_view kDigestPrefix = "sha256:";

struct FoundBlob {
    std::string digest;
    std::uint64_t bytes = 0;
    std::int64_t used_s = 0, used_ns = 0;
};

// Regular files that are named by a digest, in one of the 256 folders.
void find_blobs(const std::filesystem::path& folder, std::vector<FoundBlob>& found)
{
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        const std::string digest = std::string(kDigestPrefix) + name;
        struct stat status {};
        if (!is_digest(digest) || name.substr(0, 2) != folder.filename().string()) continue;
        if (::lstat(entry.path().c_str(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
        found.push_back({digest,
                         static_cast<std::uint64_t>(status.st_size),
                         status.st_mtim.tv_sec,
                         status.st_mtim.tv_nsec});
    }
}

} // namespace

BlobFolder::BlobFolder(std::filesystem::path folder) : folder_(std::move(folder))
{
    make_folder(folder_);
    static constexpr std::string_view digits = "0123456789abcdef";
    bool made = false;
    for (const char high : digits)
        for (const char low : digits) {
            const std::filesystem::path folder_of_byte = folder_ / std::string{high, low};
            if (::mkdir(folder_of_byte.c_str(), 0750) == 0)
                made = true;
            else if (errno != EEXIST)
                throw_io_error("make the folder", folder_of_byte, errno);
        }
    if (made) sync_folder(folder_);
}

BlobIndex BlobFolder::scan() const
try {
    std::vector<FoundBlob> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
        const std::string name = entry.path().filename().string();
        if (name.substr(0, kTemporaryPrefix.size()) == kTemporaryPrefix)
            std::filesystem::remove(entry.path());
        else if (entry.is_directory())
            find_blobs(entry.path(), found);
    }
    std::sort(found.begin(), found.end(), [](const FoundBlob& a, const FoundBlob& b) {
        return std::pair(a.used_s, a.used_ns) < std::pair(b.used_s, b.used_ns);
    });
    BlobIndex index;
    for (const FoundBlob& blob : found)
        index.add(blob.digest, {.bytes = blob.bytes});
    return index;
} catch (const std::filesystem::filesystem_error& error) {
    throw_io_error("read the folder", error.path1(), error.code().value());
}

std::filesystem::path BlobFolder::path(std::string_view digest) const
{
    const std::string_view hex = digest.substr(kDigestPrefix.size());
    return folder_ / hex.substr(0, 2) / hex;
}

std::pair<FileDescriptor, std::filesystem::path> BlobFolder::make_temporary() const
{
    std::string name = (folder_ / kTemporaryPrefix).string() + "XXXXXX";
    FileDescriptor file(::mkostemp(name.data(), O_CLOEXEC));
    if (!file) throw_io_error("make a file in", folder_, errno);
    return {std::move(file), std::filesystem::path(name)};
}

void BlobFolder::adopt(const std::filesystem::path& temporary, std::string_view digest) const
{
    const std::filesystem::path target = path(digest);
    if (::rename(temporary.c_str(), target.c_str()) != 0) throw_io_error("rename a file to", target, errno);
}

void BlobFolder::sync_name(std::string_view digest) const
{
    sync_folder(path(digest).parent_path());
}

void BlobFolder::sync_all() const
{
    sync_file_system(folder_);
}

std::optional<FileDescriptor> BlobFolder::open(std::string_view digest) const
{
    const std::filesystem::path file = path(digest);
    FileDescriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
    if (!fd && errno == ENOENT) return std::nullopt;
    if (!fd) throw_io_error("open", file, errno);
    return fd;
}

std::optional<std::vector<std::byte>> BlobFolder::read(std::string_view digest) const
{
    const std::filesystem::path file = path(digest);
    const std::optional<FileDescriptor> opened = open(digest);
    if (!opened) return std::nullopt;
    const FileDescriptor& fd = *opened;
    struct stat status {};
    if (::fstat(fd.get(), &status) != 0) throw_io_error("stat", file, errno);
    std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
    std::size_t filled = 0;
    while (filled < bytes.size()) {
        const ssize_t count = ::read(fd.get(), bytes.data() + filled, bytes.size() - filled);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0 && errno != EIO) throw_io_error("read", file, errno);
        if (count <= 0) break; // shorter than it said, or a bad sector: the digest will tell
        filled += static_cast<std::size_t>(count);
    }
    bytes.resize(filled);
    return bytes;
}

// Only the order of eviction hangs on it, so a file system that refuses is no error.
void BlobFolder::mark_used(std::string_view digest) const
{
    ::utimensat(AT_FDCWD, path(digest).c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
}

std::optional<std::filesystem::path> BlobFolder::set_aside(std::string_view digest) const
{
    const std::filesystem::path file = path(digest);
    std::filesystem::path aside = folder_ / (std::string(kTemporaryPrefix) + file.filename().string());
    if (::rename(file.c_str(), aside.c_str()) == 0) return aside;
    if (errno == ENOENT) return std::nullopt;
    // A full disk may have no room for another name.
    if (::unlink(file.c_str()) != 0 && errno != ENOENT) throw_io_error("remove", file, errno);
    return std::filesystem::path();
}

} // namespace server
