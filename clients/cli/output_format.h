// How a picture's file is written: by the extension of its name; "-" is a PNG on standard output.
//
// Errors  UserError(usage) for a name that tells no format, and for 16 bits of what has but one depth.
#pragma once

#include "renderer/description/picture_formats.h"

#include <cstdint>
#include <optional>
#include <string>

namespace clients {

renderer::PictureEncoding encoding_of(const std::string& output, std::optional<std::uint32_t> bits);

} // namespace clients
