// DataFolder: the service's folder on disk, held by an flock so that no second service opens it.
//
// Errors  StoreError when it cannot be made or another process holds it (the message names the folder).
#pragma once

#include <filesystem>

namespace server {

class DataFolder {
public:
    explicit DataFolder(const std::filesystem::path& folder);
    ~DataFolder();
    DataFolder(const DataFolder&) = delete;
    DataFolder& operator=(const DataFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    int lock_fd_ = -1;
};

} // namespace server
