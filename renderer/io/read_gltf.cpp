#include "renderer/io/read_gltf.h"

#include "renderer/io/assimp_scene.h"
#include "renderer/io/gltf_buffers.h"
#include "renderer/io/gltf_emission.h"
#include "renderer/io/gltf_outline.h"
#include "renderer/io/gltf_tree.h"
#include "renderer/io/import_bounds.h"
#include "renderer/io/text.h"

#include <string>
#include <string_view>

namespace renderer {

namespace {

std::optional<ImportFault> check(std::string_view json,
                                 std::optional<std::span<const std::byte>> binary,
                                 CompanionFiles& files,
                                 const Limits& limits)
{
    auto read = read_gltf_outline(json);
    if (auto* fault = std::get_if<ImportFault>(&read)) return std::move(*fault);
    const auto& outline = std::get<GltfOutline>(read);
    if (auto bad = check_gltf_tree(outline)) return bad;
    return check_gltf_buffers(outline, binary, files, limits);
}

ImportResult
read(const std::string& format, std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    return read_with_assimp({.format = format, .importer = "glTF2", .title = "glTF"}, bytes, files, limits);
}

ImportResult read_json(std::string_view json, CompanionFiles& files, const Limits& limits)
{
    const auto stronger = with_emissive_strength(json);
    return read(
        "gltf", std::as_bytes(std::span(stronger ? std::string_view(*stronger) : json)), files, limits);
}

ImportResult read_binary(std::span<const std::byte> bytes,
                         std::span<const std::byte> json,
                         CompanionFiles& files,
                         const Limits& limits)
{
    const auto stronger = with_emissive_strength(text_of(json));
    if (!stronger) return read("glb", bytes, files, limits);
    return read("glb", glb_with_json(bytes, json.size(), *stronger), files, limits);
}

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t offset)
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i)
        word |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
    return word;
}

} // namespace

ImportResult read_gltf(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    if (auto bad = check(text_of(bytes), std::nullopt, files, limits)) return std::move(*bad);
    return read_json(text_of(bytes), files, limits);
}

// 12 bytes of header, then chunks of (length, type, bytes): the first is the JSON.
ImportResult read_glb(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
    if (bytes.size() < 20)
        return ImportFault{"truncated",
                           "a GLB has at least 20 bytes, this file has " + std::to_string(bytes.size())};
    const std::uint32_t version = word_at(bytes, 4);
    if (version != 2)
        return ImportFault{version == 1 ? "unsupported" : "malformed",
                           "byte 4: GLB version " + std::to_string(version) + "; 2 is read"};
    const std::uint64_t length = word_at(bytes, 8), json_length = word_at(bytes, 12);
    if (length != bytes.size())
        return ImportFault{bytes.size() < length ? "truncated" : "malformed",
                           "the GLB's header promises " + std::to_string(length) + " bytes, the file has " +
                               std::to_string(bytes.size())};
    if (word_at(bytes, 16) != kJson)
        return ImportFault{"malformed", "byte 16: the GLB's first chunk is not JSON"};
    if (json_length > bytes.size() - 20)
        return ImportFault{"malformed",
                           "byte 12: the GLB's JSON chunk of " + std::to_string(json_length) +
                               " bytes passes its end"};
    std::optional<std::span<const std::byte>> binary;
    for (std::size_t at = 20 + json_length; at < bytes.size();) {
        if (bytes.size() - at < 8 || word_at(bytes, at) > bytes.size() - at - 8)
            return ImportFault{"malformed",
                               "byte " + std::to_string(at) + ": a chunk of the GLB passes its end"};
        const std::size_t size = word_at(bytes, at);
        if (!binary && word_at(bytes, at + 4) == kBinary) binary = bytes.subspan(at + 8, size);
        at += 8 + size;
    }
    const auto json = bytes.subspan(20, json_length);
    if (auto bad = check(text_of(json), binary, files, limits)) return std::move(*bad);
    // Without a binary chunk assimp takes the first buffer for an empty one, whatever its URI holds.
    ImportResult result =
        binary ? read_binary(bytes, json, files, limits) : read_json(text_of(json), files, limits);
    if (auto* mesh = std::get_if<ImportedMesh>(&result)) mesh->format = "glb";
    return result;
}

} // namespace renderer
