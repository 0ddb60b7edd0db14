// check_gltf_buffers: do a glTF's buffers hold what its views, accessors and primitives promise, and are all
// indices in range? assimp drops triangles with bad indices without a word, and has read beyond buffers.
//
// Errors  "truncated" (a buffer is shorter than it says), "malformed" (something lies outside what holds it),
//         "missing_file", "index_out_of_range", "unsupported" (sparse accessors), "over_limit".
// Cost    linear in the JSON and in the bytes that indices take; data: URIs are decoded.
#pragma once

#include "renderer/io/companion_files.h"
#include "renderer/io/gltf_outline.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace renderer {

// `binary`: the binary chunk, of a GLB that has one.
std::optional<ImportFault> check_gltf_buffers(const GltfOutline& outline,
                                              std::optional<std::span<const std::byte>> binary,
                                              CompanionFiles& files,
                                              const Limits& limits);

// A companion by URI: by the name as it stands, then with its percent escapes resolved.
std::optional<std::span<const std::byte>> open_uri(CompanionFiles& files, std::string_view uri);

// The bytes of "data:...;base64,..."; nothing if it is not that.
std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri);

} // namespace renderer
