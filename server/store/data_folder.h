// DataFolder: the service's folder on disk, held by an flock so that no second service opens it.
//
// Errors  StoreError when it cannot be made or another process holds it (the message names the folder).
#pragma once

#include "server/store/file_descriptor.h"

#include <filesystem>

namespace server {

class DataFolder {
public:
    explicit DataFolder(const std::filesystem::path& folder);
    DataFolder(const DataFolder&) = delete;
    DataFolder& operator=(const DataFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    // Closing it lets go of the lock; the file stays, since removing it would let two processes lock two files.
    FileDescriptor lock_;
};

} // namespace server
