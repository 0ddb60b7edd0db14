// Shapes that are meshes: the unit rectangle and the unit box, with normals and texture coordinates.
#pragma once

#include "renderer/geometry/mesh.h"

namespace renderer {

// Two triangles in the xy plane, from -1/2 to 1/2, facing +z; u runs along x, v along y.
Mesh unit_rectangle();

// Twelve triangles, from -1/2 to 1/2 on every axis, facing outwards; four vertices a face, so that normals
// are flat; every face has the whole of texture space.
Mesh unit_box();

} // namespace renderer
