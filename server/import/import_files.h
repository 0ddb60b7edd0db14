// ImportFiles: the assets that an import reads, opened, and held against their digests.
//
// Errors  std::system_error when a file that is there cannot be opened; DamagedBlob for one whose bytes are not what its
//         digest says.
// Threads any number at once. The store must outlive it.
#pragma once

#include "server/import/import_cache.h"
#include "server/store/blob_store.h"
#include "server/store/file_descriptor.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace server {

class ImportFiles {
public:
    explicit ImportFiles(BlobStore& blobs) : blobs_(blobs) {}

    FileDescriptor open(const std::string& digest) const; // none: it is not uploaded
    // Whether the bytes are what the digest says, without holding them; false if they are there no more.
    bool are_sound(const FileDescriptor& file, const std::string& digest) const;
    // A file of the job by the name that the mesh uses, sound or none; what was answered is part of the cache's key.
    FileDescriptor open_companion(const std::map<std::string, std::string>& files,
                                  std::string_view name,
                                  NamedDigests& answers) const;
    // Of all the files that an import may open.
    std::uint64_t bytes_of(const std::string& digest, const std::map<std::string, std::string>& files) const;

private:
    BlobStore& blobs_;
};

// Of what cannot be read: of nothing, so that a file made beside it is told from one made beside something.
std::string digest_of_file(const std::filesystem::path& path);

} // namespace server
