// glTF's KHR_materials_emissive_strength, which assimp 5.2 does not know: the strength is multiplied into the
// emissiveFactor of its own material, in the JSON, before assimp reads it. So it cannot reach another material,
// whatever order assimp loads them in.
//
// Source  KHR_materials_emissive_strength: "the emissive factor is multiplied by emissiveStrength"; a factor that is
//         not there is black.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace renderer {

// Nothing: no material's emission changes, or the JSON cannot be read.
std::optional<std::string> with_emissive_strength(std::string_view json);

// A GLB like `glb` with that JSON in its first chunk, whose old one has `json_length` bytes.
std::vector<std::byte>
glb_with_json(std::span<const std::byte> glb, std::size_t json_length, std::string_view json);

} // namespace renderer
