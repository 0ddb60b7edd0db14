// GltfOutline: what must hold of a glTF's JSON before assimp may see it: bounded nesting, nodes that form
// trees, no extension that we cannot read.
//
// Why     assimp follows children without looking back: 786 bytes of nodes that share children took 4 GiB.
// Source  glTF 2.0 specification, 3.5.2 "Node hierarchy": nodes form a set of disjoint strict trees.
// Cost    one pass over the JSON, nothing kept but the children of nodes.
#pragma once

#include "renderer/io/import_mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace renderer {

struct GltfOutline {
    std::vector<std::vector<std::uint32_t>> children;    // of every node
    std::vector<std::vector<std::uint32_t>> scene_roots; // of every scene
    std::vector<std::string> required_extensions;
    std::string version; // asset.version
};

std::variant<GltfOutline, ImportFault> read_gltf_outline(std::string_view json);

// "malformed" for a node with two parents, in a cycle or missing; "over_limit" for a chain that is too deep;
// "unsupported" for other versions and unknown required extensions.
std::optional<ImportFault> check_gltf_outline(const GltfOutline& outline);

} // namespace renderer
