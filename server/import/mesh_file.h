// One prepared mesh as a file: its layout, writing and proving it. See stored_meshes.h for what it promises.
//
// Layout  Head, the text of the answers, the tree's head, a SHA-256 of every MiB of the body; from the next
//         page on the body: the flat form, then the tree's arrays, each at a multiple of 64 bytes.
#pragma once

#include "renderer/parallel/thread_pool.h"
#include "server/import/import_cache.h"
#include "server/import/mapped_bytes.h"
#include "server/store/file_io.h"

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

namespace server {

// Writes and syncs the whole. False if `stop` was requested; StoreError if it cannot be written.
bool write_mesh_file(const FileDescriptor& file,
                     const std::filesystem::path& path,
                     const KnownImport& known,
                     renderer::MeshTree tree,
                     const std::stop_token& stop);

struct MeshFileFault {
    std::string why;
};

// Of files of this key that are whole and sound: what was written. The fault says what is damaged; nothing if
// the file is sound and of other answers than `files` would give.
std::variant<std::monostate, KnownImport, MeshFileFault> read_mesh_file(const MappedBytes& file,
                                                                        const std::string& main,
                                                                        const NamedDigests& files,
                                                                        renderer::MeshTree tree,
                                                                        renderer::ThreadPool& pool);

} // namespace server
