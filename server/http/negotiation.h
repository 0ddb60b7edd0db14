// What a client would like: Prefer: wait (RFC 7240), Accept, Cache-Control: no-cache. Malformed wishes are
// not faults: they are left unheard, as the RFCs say.
#pragma once

#include "renderer/description/layers.h"
#include "renderer/description/picture_formats.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace server {

// N of `wait=N`; nothing where there is none.
std::optional<std::uint64_t> preferred_wait_s(const std::string& prefer);

// Accept (RFC 9110, 12.5.1): of the ranges that name a format the most exact one counts, then its q.
struct Acceptance {
    bool only_images = false; // every type that it names is image/...
    std::array<int, renderer::kPictureFormats.size()>
        quality{}; // thousandths, as in the table; 0: not this one

    bool takes(renderer::PictureFormat format) const { return quality[static_cast<std::size_t>(format)] > 0; }
    // What suits best, of equals the first of the table; nothing: none of them.
    std::optional<renderer::PictureFormat> best() const;
    // The same of the formats that hold a layer: of equals the first of OpenEXR, PFM, PNG.
    std::optional<renderer::PictureFormat> best_of(renderer::Layer layer) const;
};
Acceptance read_accept(const std::string& accept);

bool wants_fresh(const std::string& cache_control);

} // namespace server
