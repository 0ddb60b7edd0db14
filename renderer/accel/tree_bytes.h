// TreeBytes: a tree as plain bytes, for who keeps prepared meshes on disk: good for the very same build alone,
// since they are the arrays as they stand in memory.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace renderer {

struct TreeBytes {
    static constexpr std::size_t kAlignment = 64; // of where an array may lie
    std::vector<std::byte> head;                  // what is no array
    std::vector<std::span<const std::byte>> arrays;
};

} // namespace renderer
