#include "server/import/allowance.h"

#include "api/words/limit_words.h"

#include <algorithm>

namespace server {

renderer::Limits allowance(const renderer::Limits& limits, std::uint64_t bytes)
{
    constexpr std::uint64_t kLeast = 256u << 20, kEach = 12, kMostBytes = 1ull << 56, kLeast_s = 10;
    bytes = std::min(bytes, kMostBytes);
    renderer::Limits allowed = limits;
    const std::uint64_t room = kLeast + kEach * bytes;
    allowed.import_memory_bytes = std::min(limits.import_memory_bytes, room);
    allowed.import_output_bytes = std::min(limits.import_output_bytes, room);
    allowed.import_s = std::min(limits.import_s, kLeast_s + (bytes >> 20));
    return allowed;
}

std::string allowance_words(const char* limit)
{
    return "256 MiB + 12 for every byte of its files, and no more than " + api::flag_of(limit) + " says";
}

} // namespace server
