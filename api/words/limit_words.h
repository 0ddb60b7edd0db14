// Limits in words: which flag raises one, and the fault that names it.
#pragma once

#include "api/problem.h"
#include "renderer/description/limits.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace api {

std::string flag_of(std::string_view limit);        // "--limit-image-side-px"
std::string environment_of(std::string_view limit); // "HELIOGRAPH_LIMIT_IMAGE_SIDE_PX"
std::string raise_words(std::string_view limit);    // "the service raises it with --limit-image-side-px"

// The value of the limit so named; `limit` must be in limit_table().
std::uint64_t value_of(std::string_view limit, const renderer::Limits& limits);

// "the asset is over the limit asset_bytes, 1000 bytes; the service raises it with --limit-asset-bytes"
std::string over_limit_words(std::string_view what, std::string_view limit, const renderer::Limits& limits);
// "30000 is over the limit image_side_px, 8192 pixels; ..."
Problem
over_limit(std::string pointer, std::string_view limit, std::uint64_t asked, const renderer::Limits& limits);

} // namespace api
