// validate_mesh: does this Mesh keep every promise of mesh.h? Used on what importers made and on what a
// sandboxed importer sent, which is as hostile as the file.
#pragma once

#include "renderer/description/fault.h"
#include "renderer/geometry/mesh.h"

#include <optional>

namespace renderer {

// The first fault (codes "no_triangles", "index_out_of_range", "non_finite", "inconsistent"), naming the
// vertex or triangle; its pointer is empty. O(vertices + triangles).
std::optional<Fault> validate_mesh(const Mesh& mesh);

} // namespace renderer
