// read_gltf: glTF 2.0 and GLB, through assimp, flattened: every node's triangles placed by its transform.
//
// Order      depth first, so that a node and all below it are one run of triangles: a MeshPart by its name.
// Materials  baseColorFactor becomes the diffuse colour.
// Errors     "malformed", "truncated", "missing_file", "unsupported", "index_out_of_range", "over_limit".
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <span>

namespace renderer {

ImportResult read_gltf(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits);
ImportResult read_glb(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits);

} // namespace renderer
