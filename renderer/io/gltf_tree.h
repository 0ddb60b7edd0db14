// check_gltf_tree: does assimp come to an end on this glTF, and can we read what it requires?
//
// Why     assimp follows children without looking back: 786 bytes of nodes that share children took 4 GiB.
// Source  glTF 2.0 specification, 3.5.2 "Node hierarchy": nodes form a set of disjoint strict trees.
#pragma once

#include "renderer/io/gltf_outline.h"

#include <optional>

namespace renderer {

// "malformed" for a node with two parents, in a cycle or missing; "over_limit" for a chain that is too deep;
// "unsupported" for other versions and unknown required extensions.
std::optional<ImportFault> check_gltf_tree(const GltfOutline& outline);

} // namespace renderer
