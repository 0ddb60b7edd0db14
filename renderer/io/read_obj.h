// read_obj: Wavefront OBJ (polygons, groups, materials) as a mesh; lines and points are left out and counted.
//
// Vertices  one for every (v, vt, vn) that a face uses, in the order of first use; the rest is dropped.
// Normals   the file's. Where only some corners have one, the others get their face's: those stay flat.
// Parts     every `o` (where there is none, every `g`), its triangles made contiguous.
// Errors    "truncated", "malformed", "index_out_of_range", "non_finite", "over_limit", with the line.
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

#include <string_view>

namespace renderer {

ImportResult read_obj(std::string_view text, CompanionFiles& files, const Limits& limits);

} // namespace renderer
