// TempFolder: an empty folder of a test's own, gone with it.
#pragma once

#include <filesystem>
#include <string>

namespace tests {

class TempFolder {
public:
    TempFolder();
    ~TempFolder();
    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::string file(const std::string& name) const { return (path_ / name).string(); }
    // Writes a file into it and gives its path.
    std::string write(const std::string& name, const std::string& bytes) const;

private:
    std::filesystem::path path_;
};

// The whole file; throws std::runtime_error if it cannot be read.
std::string bytes_of(const std::filesystem::path& path);

} // namespace tests
