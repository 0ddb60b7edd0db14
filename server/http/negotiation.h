// What a client would like: Prefer: wait (RFC 7240), Accept, Cache-Control: no-cache. Malformed wishes are
// not faults: they are left unheard, as the RFCs say.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace server {

// N of `wait=N`; nothing where there is none.
std::optional<std::uint64_t> preferred_wait_s(const std::string& prefer);

struct Acceptance {
    bool only_images = false; // every type that it names is image/...
    bool png = true;          // a PNG would do
};
Acceptance read_accept(const std::string& accept);

bool wants_fresh(const std::string& cache_control);

} // namespace server
