// run_import: one file through one heliograph-import child, and what came of it.
//
// Threads  waits for the child on the calling thread; any number of threads may run one each.
// Errors   whatever the file or the child does is a value. std::system_error: no child could be started.
#pragma once

#include "renderer/description/limits.h"
#include "server/import/flat_mesh.h"
#include "server/store/file_descriptor.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

namespace server {

struct ImportRun {
    std::filesystem::path program; // heliograph-import
    int file = -1;                 // open for reading
    std::string extension;         // ".obj" where the name had one: a hint for what the content does not tell
    bool is_picture = false;       // is wanted: else a mesh is, and what the file is is told
    std::function<FileDescriptor(std::string_view name)>
        open; // companion files; called on the calling thread
    renderer::Limits limits;
    std::uint64_t bytes = 0; // of all the files that it may open: what it may use grows with them
};

struct ImportRunEnd {
    std::optional<ImportOutcome> outcome; // nothing if `stop` was requested
    bool repeatable = true;               // false: another time it might come out otherwise (time, memory)
    std::uint64_t peak_bytes =
        0; // of the child, but no less than of this process when it started it (Linux counts so)
    double cpu_s = 0;
    std::string log; // what the child wrote to its log, bounded; as hostile as the file
};

ImportRunEnd run_import(const ImportRun& run, std::stop_token stop);

} // namespace server
