// File access that keeps its word: whole writes, files and folders made to last.
//
// Errors  StoreError that names the path and what was attempted; ENOSPC and EDQUOT as storage_full.
#pragma once

#include "server/store/file_descriptor.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace server {

// Throws StoreError: "cannot <action> <path>: <errno's words>".
[[noreturn]] void throw_io_error(const std::string& action, const std::filesystem::path& path, int error);

void write_all(const FileDescriptor& file,
               std::span<const std::byte> bytes,
               const std::filesystem::path& path);
void sync_file(const FileDescriptor& file, const std::filesystem::path& path); // fsync
void sync_folder(const std::filesystem::path& folder); // its entries: renames, new files
// Everything that was written to the file system that holds the folder: many files at the price of one.
void sync_file_system(const std::filesystem::path& folder);
// Makes the folder and what is missing above it, each new one durable in its parent. False if it was there.
bool make_folder(const std::filesystem::path& folder);

} // namespace server
