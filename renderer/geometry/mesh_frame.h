// mesh_frame: where a mesh's own frame has its origin, and how its positions become floats there.
//
// Rule    a mesh whose largest coordinate is 10,000 times its size or more is kept relative to an origin near its
//         middle, a multiple of a power of two of its size, so that the subtraction is exact; all others stay as
//         their file has them. What a float then still rounds off is kept as residuals where it could be seen: where
//         some triangle's longest edge is below 2^-20 of its coordinates, 16 times what rounding moves a corner.
// Units   as in the file. Cost: linear; a float mesh near the origin is only looked through.
#pragma once

#include "renderer/geometry/mesh.h"

#include <span>

namespace renderer {

// For a mesh whose triangles are complete: takes the positions in the file's coordinates, as exactly as it says
// them, and fills origin, positions and residuals. All are finite and within float's range.
void set_positions(Mesh& mesh, std::span<const Vec3d> in_file);

// The same for a mesh whose positions are the file's own floats: there is nothing to be rounded off.
void choose_origin(Mesh& mesh);

} // namespace renderer
