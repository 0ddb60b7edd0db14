// read_3ds: 3D Studio's .3ds, through assimp, flattened as glTF is.
//
// Frame   the file's units as they are; its z becomes y.
// Errors  "truncated", "malformed", "index_out_of_range", "non_finite", "over_limit", with the byte: assimp
//         moves indices that are out of range to the last vertex and reads on where chunks lie.
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace renderer {

bool is_3ds(std::string_view bytes);
ImportResult read_3ds(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits);

} // namespace renderer
