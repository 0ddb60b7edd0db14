// lock_down: what heliograph-import gives up before it looks at the first hostile byte.
//
// Now     address space, processor time, size of what it writes, open files, processes, core dumps; no new
//         privileges; not to be traced; first to go when memory is short; dies with the service.
// Not     files and the network: a parser that a hostile file has taken over can open, read and send whatever
//         the service's user can. Landlock and a seccomp list belong here, and are not here yet.
// Errors  what cannot be had is told as false with the reason: the importer then refuses to read anything.
#pragma once

#include <cstdint>
#include <string>

namespace server {

struct LockdownBounds {
    std::uint64_t memory_bytes =
        0; // not kept in sanitizer builds: their shadow memory needs the whole address space
    std::uint64_t output_bytes = 0;
    std::uint64_t cpu_s = 0;
};

bool lock_down(const LockdownBounds& bounds, std::string& why_not);

} // namespace server
