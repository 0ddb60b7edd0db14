// read_stl: STL, binary or ASCII, as a mesh; corners at the very same place become one vertex.
//
// Normals  none: an STL's are one a facet and say no more than the winding does.
// Errors   "truncated", "malformed", "non_finite", "over_limit", with the facet or line.
#pragma once

#include "renderer/io/import_mesh.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace renderer {

// Facets of a binary STL, if its size is exactly what its count asks for.
std::optional<std::uint32_t> binary_stl_facets(std::string_view bytes);

ImportResult read_binary_stl(std::string_view bytes, const Limits& limits);
ImportResult read_ascii_stl(std::string_view text, const Limits& limits);

} // namespace renderer
