// GltfOutline: what a glTF's JSON says of its nodes and of where its bytes lie: as much as must be checked
// before assimp may see it. Strings are views into the JSON, as they stand there (escapes are not resolved).
//
// Errors  "truncated" or "malformed", with the byte: no JSON, nested more than 64 deep, not of glTF's shape,
//         or a member named twice or in escapes, which assimp might understand otherwise.
// Cost    one pass over the JSON.
#pragma once

#include "renderer/io/import_mesh.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace renderer {

struct GltfBuffer {
    std::optional<std::string_view> uri; // none: the binary chunk of a GLB
    std::uint32_t length = 0;
};

struct GltfView {
    std::uint32_t buffer = 0, offset = 0, length = 0;
    std::uint32_t stride = 0; // 0: packed
};

struct GltfAccessor {
    std::optional<std::uint32_t> view;
    std::uint32_t offset = 0, count = 0;
    std::uint32_t component_type = 0; // 5120 to 5126
    std::string_view type;            // "SCALAR", "VEC3", ...
    bool sparse = false;
};

struct GltfPrimitive {
    std::uint32_t mesh = 0;
    std::uint32_t mode = 4; // triangles
    std::optional<std::uint32_t> indices, positions;
    std::vector<std::uint32_t> attributes; // accessors, those of morph targets among them
};

struct GltfOutline {
    std::vector<std::vector<std::uint32_t>> children;    // of every node
    std::vector<std::vector<std::uint32_t>> scene_roots; // of every scene
    std::vector<GltfBuffer> buffers;
    std::vector<GltfView> views;
    std::vector<GltfAccessor> accessors;
    std::vector<GltfPrimitive> primitives;
    std::vector<std::string_view> required_extensions;
    std::string_view version; // asset.version
};

std::variant<GltfOutline, ImportFault> read_gltf_outline(std::string_view json);

} // namespace renderer
