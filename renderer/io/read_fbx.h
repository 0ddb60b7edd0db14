// read_fbx: FBX, binary and text, through assimp, flattened as glTF is.
//
// Frame   metres and y up: GlobalSettings' UnitScaleFactor (centimetres a unit) and UpAxis are applied; files
//         without them are taken for centimetres with y up, which is FBX's own default.
// Errors  "truncated", "malformed", "unsupported", "index_out_of_range", "non_finite", "over_limit". Records,
//         arrays and connections are checked before assimp sees the file; a compressed array may not promise
//         more than deflate can hold.
// Source  the binary layout as Blender's developers describe it ("FBX binary file format specification").
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace renderer {

ImportResult read_fbx(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits);

// The two forms of what read_fbx() does first.
std::optional<ImportFault> check_binary_fbx(std::string_view bytes, const Limits& limits);
std::optional<ImportFault> check_text_fbx(std::string_view text);

} // namespace renderer
