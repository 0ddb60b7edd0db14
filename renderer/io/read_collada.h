// read_collada: COLLADA (.dae), through assimp, flattened as glTF is.
//
// Frame      metres and y up: the file's <unit> and <up_axis> are applied.
// Not read   a zip archive (.zae), also where one hangs behind the XML; document types. Textures are told by
//            name; other documents that a URL names are not opened.
// Errors     "truncated", "malformed", "unsupported", "index_out_of_range", "non_finite", "over_limit"; nodes
//            that instance one another in a circle, or too often, are found before assimp sees the file.
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <span>

namespace renderer {

ImportResult read_collada(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits);

} // namespace renderer
