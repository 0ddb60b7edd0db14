#include "server/import/import_files.h"

#include "api/words/digest.h"
#include "server/import/mapped_bytes.h"

#include <cerrno>
#include <cstddef>
#include <fcntl.h>
#include <set>
#include <span>
#include <system_error>

namespace server {

namespace {

constexpr BlobStore::Kind kAsset = BlobStore::Kind::asset;

} // namespace

FileDescriptor ImportFiles::open(const std::string& digest) const
{
    const int fd = ::open(blobs_.path(kAsset, digest).c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0 && errno != ENOENT) throw std::system_error(errno, std::generic_category(), "open an asset");
    return FileDescriptor(fd);
}

bool ImportFiles::are_sound(const FileDescriptor& file, const std::string& digest) const
{
    const MappedBytes mapped = map_file(file.get());
    if (digest_of(mapped.bytes) != digest)
        return blobs_.read(kAsset, digest).has_value(); // which tells and marks the damage
    blobs_.touch(kAsset, digest);
    return true;
}

FileDescriptor ImportFiles::open_companion(const std::map<std::string, std::string>& files,
                                           std::string_view name,
                                           NamedDigests& answers) const
{
    const auto file = files.find(std::string(name));
    FileDescriptor fd = file == files.end() ? FileDescriptor() : open(file->second);
    if (fd && !are_sound(fd, file->second)) fd.reset();
    answers[std::string(name)] = fd ? file->second : "";
    return fd;
}

std::uint64_t ImportFiles::bytes_of(const std::string& digest,
                                    const std::map<std::string, std::string>& files) const
{
    std::set<std::string_view> digests{digest};
    for (const auto& [name, of_file] : files)
        digests.insert(of_file);
    std::uint64_t bytes = 0;
    for (const std::string_view one : digests)
        bytes += blobs_.size(kAsset, one).value_or(0);
    return bytes;
}

std::string digest_of_file(const std::filesystem::path& path)
{
    const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    return digest_of(file ? map_file(file.get()).bytes : std::span<const std::byte>());
}

} // namespace server
