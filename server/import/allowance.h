// Allowance: what one import may use. It grows with the files, so that a small file cannot take what only a
// large one needs, up to the limits, which are flags.
//
// Memory  256 MiB + 12 a byte. The file itself is mapped, 1 a byte; our readers hold at most 8 a byte beside
//         it, and the flat form is on its way for as much as the mesh takes.
// Output  the same: what a scene graph places several times is larger than its file.
// Time    of the processor, 10 s + 1 s a MiB: the slowest reader was seen to take 0.2 s a MiB here.
#pragma once

#include "renderer/description/limits.h"

#include <cstdint>
#include <string>

namespace server {

// Of `bytes` in all the files that the import may open; the limits where those are less.
renderer::Limits allowance(const renderer::Limits& limits, std::uint64_t bytes);

// For messages: of where an allowance of memory or output comes from. `limit` is its name.
std::string allowance_words(const char* limit);

} // namespace server
