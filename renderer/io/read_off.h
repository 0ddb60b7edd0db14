// read_off: OFF in text (OFF, COFF, NOFF, STOFF and what they combine to) as a mesh.
//
// Vertices  the file's, all of them, in its order; normals (N) and texture coordinates (ST) where given,
//           colours left out.
// Errors    "truncated", "malformed", "index_out_of_range", "non_finite", "over_limit", with the line;
//           "unsupported" for binary files and those of other dimensions (4OFF, nOFF).
// Source    Geomview's manual, "OFF: Object File Format".
#pragma once

#include "renderer/io/import_mesh.h"

#include <string_view>

namespace renderer {

bool is_off(std::string_view text);
ImportResult read_off(std::string_view text, const Limits& limits);

} // namespace renderer
