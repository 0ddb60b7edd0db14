// BlobShelf: one kind of blobs: what is there, in memory, over the folder that holds it.
//
// Threads  every function may be called from any thread. The mutex guards the index alone: it is held over a
//          rename, never while bytes are read, written, synced or given back to the disk.
// Errors   StoreError; DamagedBlob where the bytes are not what their name says.
#pragma once

#include "server/store/blob_folder.h"
#include "server/store/blob_index.h"
#include "server/store/blob_reader.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace server {

// A finished temporary file.
struct IncomingBlob {
    const FileDescriptor& file;
    const std::filesystem::path& path;
    std::string digest;
    std::uint64_t bytes = 0;
};

class BlobShelf {
public:
    BlobShelf(const std::filesystem::path& folder, bool of_assets)
        : folder_(folder), index_(folder_.scan()), of_assets_(of_assets)
    {
    }

    const BlobFolder& folder() const { return folder_; }
    // True if the blob is there already, byte for byte, and as durable as asked for: then it was used now, and
    // the file is the caller's to remove.
    bool keeps(const IncomingBlob& blob, bool durable);
    // Takes the file in; it has no other name afterwards.
    void take(const IncomingBlob& blob, bool durable);
    void make_durable(const std::vector<std::string>& digests);

    std::optional<std::uint64_t> size(std::string_view digest) const;
    std::optional<std::vector<std::byte>> read(std::string_view digest);
    std::unique_ptr<BlobReader> open(std::string_view digest);
    bool remove(std::string_view digest);
    void touch(std::string_view digest);
    std::uint64_t total_bytes() const;
    std::vector<std::string> list() const;
    bool make_room(std::uint64_t bytes,
                   std::uint64_t limit,
                   const std::function<std::vector<std::string>()>& in_use);

private:
    std::optional<std::uint64_t> file_of(std::string_view digest) const; // nothing if it is not there
    DamagedBlob damage(std::string_view digest) const;
    void mark_damaged(std::string_view digest, std::uint64_t file);
    void forget_if_gone(std::string_view digest);

    const BlobFolder folder_;
    mutable std::mutex mutex_; // of index_
    BlobIndex index_;
    const bool of_assets_;
};

} // namespace server
