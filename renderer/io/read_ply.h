// read_ply: PLY, ASCII or binary of either byte order, with polygons (`element face`) and triangle strips
// (`element tristrips`), as a mesh.
//
// Vertices  the file's, all of them, in its order; nx ny nz and u v (s t, texture_u texture_v) where given.
// Errors    "truncated" (less data than the header promises), "malformed", "index_out_of_range",
//           "non_finite", "over_limit", with the element's number and the byte or line.
#pragma once

#include "renderer/io/import_mesh.h"

#include <string_view>

namespace renderer {

ImportResult read_ply(std::string_view bytes, const Limits& limits);

} // namespace renderer
