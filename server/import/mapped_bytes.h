// MappedBytes: the bytes of a file as they stand in memory, mapped for reading, as long as anyone holds them.
//
// Threads  any number may read.
// Safety   whoever maps a file sees to it that nobody changes it or cuts it short meanwhile: reading beyond
//          its end is SIGBUS. Removing its name does no harm.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace server {

struct MappedBytes {
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> keeper; // null: nothing is mapped
};

// The whole file; empty, without a keeper, if it has no bytes or cannot be mapped.
MappedBytes map_file(int fd);

} // namespace server
