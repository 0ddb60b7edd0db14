// BlobFolder: one kind of blobs on disk: where a digest's file is, temporary files, what a start finds.
//
// Its 256 folders are made at the start, so that a new blob makes none.
//
// Threads  any: it holds nothing but the path.
// Errors   StoreError.
#pragma once

#include "server/store/blob_index.h"
#include "server/store/file_io.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace server {

class BlobFolder {
public:
    explicit BlobFolder(std::filesystem::path folder);

    // What is there, by last use; removes temporary files.
    BlobIndex scan() const;
    std::filesystem::path path(std::string_view digest) const;
    // A new file of a name that scan() would remove.
    std::pair<FileDescriptor, std::filesystem::path> make_temporary() const;
    // Renames a finished temporary file to its digest's name; the name lasts once the folder is synced.
    void adopt(const std::filesystem::path& temporary, std::string_view digest) const;
    // Makes the name of an adopted file last; its bytes are synced by who wrote them.
    void sync_name(std::string_view digest) const;
    // Everything that was adopted so far, names and bytes.
    void sync_all() const;
    std::optional<FileDescriptor> open(std::string_view digest) const; // nothing if it is not there
    // The file's bytes; nothing if it is not there.
    std::optional<std::vector<std::byte>> read(std::string_view digest) const;
    void mark_used(std::string_view digest) const;
    // Takes the blob away: nothing if it was not there, else the temporary name under which it waits to be
    // unlinked, which may take a while.
    std::optional<std::filesystem::path> set_aside(std::string_view digest) const;

private:
    std::filesystem::path folder_;
};

} // namespace server
