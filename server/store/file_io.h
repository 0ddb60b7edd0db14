// File access that keeps its word: descriptors that close themselves, whole writes, folders made to last.
//
// Errors  StoreError that names the path and what was attempted; ENOSPC and EDQUOT as storage_full.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace server {

class FileDescriptor {
public:
    explicit FileDescriptor(int fd = -1) : fd_(fd) {}
    ~FileDescriptor() { reset(); }
    FileDescriptor(FileDescriptor&& other) noexcept : fd_(other.release()) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept;
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;

    int get() const { return fd_; }
    explicit operator bool() const { return fd_ >= 0; }
    int release();
    void reset();

private:
    int fd_;
};

// Throws StoreError: "cannot <action> <path>: <errno's words>".
[[noreturn]] void throw_io_error(const std::string& action, const std::filesystem::path& path, int error);

void write_all(const FileDescriptor& file,
               std::span<const std::byte> bytes,
               const std::filesystem::path& path);
void sync_file(const FileDescriptor& file, const std::filesystem::path& path); // fsync
void sync_folder(const std::filesystem::path& folder); // its entries: renames, new files
// Makes the folder and what is missing above it, each new one durable in its parent. False if it was there.
bool make_folder(const std::filesystem::path& folder);

} // namespace server
