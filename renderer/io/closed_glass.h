// keep_closed_glass: only a closed surface bounds a body. Glass that is a sheet would be entered and never left, so
// it stays opaque, which is told.
//
// Rule    closed: each edge of the material's triangles is passed as often one way as the other, corners being one where
//         their positions are.
// Cost    n log n of the triangles that are of glass; nothing where none is.
#pragma once

#include "renderer/geometry/mesh.h"

#include <string>
#include <vector>

namespace renderer {

// The mesh's indices are in range.
void keep_closed_glass(Mesh& mesh, std::vector<std::string>& notes);

} // namespace renderer
