// Bounds that every reader of this room keeps, and how it tells that one was passed.
#pragma once

#include "renderer/description/limits.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace renderer {

constexpr std::size_t kMostNotes = 16;
constexpr std::size_t kMostMaterials = 65535; // numbered in 16 bits, the last one kept for "none given"

inline ImportFault over_triangle_limit(std::uint64_t triangles, const Limits& limits, bool at_least)
{
    return {"over_limit",
            (at_least ? "at least " : "") + std::to_string(triangles) + " triangles, the limit is " +
                std::to_string(limits.triangles) + " (--limit-triangles)"};
}

// What positions and triangles alone take in the flat form, told before anything is allocated for them.
inline std::optional<ImportFault>
over_output_limit(std::uint64_t vertices, std::uint64_t triangles, const Limits& limits)
{
    const std::uint64_t bytes =
        vertices * sizeof(Vec3f) + triangles * sizeof(Triangle); // counts of files in memory
    if (bytes <= limits.import_output_bytes) return std::nullopt;
    return ImportFault{"over_limit",
                       std::to_string(vertices) + " vertices and " + std::to_string(triangles) +
                           " triangles take at least " + std::to_string(bytes) +
                           " bytes when imported, the limit is " +
                           std::to_string(limits.import_output_bytes) + " (--limit-import-output-bytes)"};
}

} // namespace renderer
