// import_mesh: reads a mesh file of any format of mesh_formats.h into a Mesh, and trusts no byte of it.
//
// Files   the importer asks `open` for every file by the name that the file itself uses (an MTL, a buffer);
//         nothing else is ever opened, nothing from disk or network. Names that could lead elsewhere
//         (absolute, "..", a scheme) are never asked for.
// Errors  faults are values with a plain sentence; never a half-read mesh. A missing MTL is a note. Throws
//         std::bad_alloc alone. glTF, FBX, COLLADA and 3DS go through assimp, which hostile files may crash:
//         services import in a process of its own.
// Cost    linear in the file; memory a small multiple of it, bounded by `limits`.
#pragma once

#include "renderer/description/limits.h"
#include "renderer/geometry/mesh.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace renderer {

struct ImportFault {
    std::string code;   // "unknown_format", "truncated", "no_triangles", "index_out_of_range", ...
    std::string detail; // one sentence: what, where in the file, how to mend it
};

struct ImportedMesh {
    Mesh mesh;
    std::string format;                    // its name in mesh_formats.h
    std::vector<std::string> opened_files; // every other file that was asked for and found, sorted
    std::vector<std::string> notes;        // "material file x.mtl did not come with the mesh ...", ...
};

// Bytes of a file by name, or nothing if there is none. The span lives as long as the import.
using OpenFile = std::function<std::optional<std::span<const std::byte>>(std::string_view name)>;

using ImportResult = std::variant<ImportedMesh, ImportFault>;

// The format is told from the content first, then from the name's extension.
ImportResult import_mesh(std::string_view name,
                         std::span<const std::byte> bytes,
                         const OpenFile& open,
                         const Limits& limits);

} // namespace renderer
