// Bounds that every reader of this room keeps, and how it tells that one was passed.
#pragma once

#include "renderer/description/limits.h"
#include "renderer/io/import_mesh.h"

#include <cstddef>
#include <cstdint>
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

} // namespace renderer
