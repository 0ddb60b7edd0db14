// read_with_assimp: a file that was checked, through one of assimp's readers, as one Mesh.
//
// Safety  all other readers leave the Importer first: it has 48, most of them with known holes, and tries
//         them by content. Names resolve through CompanionFiles alone. assimp drops what it cannot make sense
//         of and goes on; what it complains of is a fault where it is of the mesh, else a note: nothing goes
//         missing in silence.
// Errors  "missing_file", "index_out_of_range", "truncated", "malformed" with assimp's words, what
//         flatten_scene() finds. Throws std::bad_alloc.
// Threads one at a time in a process waits for another: assimp's log is one.
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <span>
#include <string>

namespace renderer {

struct AssimpReader {
    std::string format;   // "gltf", "fbx", ...: the extension that assimp knows it by
    std::string importer; // how the name of its reader begins
    std::string title;    // for sentences: "glTF"
};

ImportResult read_with_assimp(const AssimpReader& reader,
                              std::span<const std::byte> bytes,
                              CompanionFiles& files,
                              const Limits& limits);

} // namespace renderer
