// Picture files as linear pictures: PNG (8 or 16 bits) and JPEG, taken as sRGB; PFM, Radiance HDR and OpenEXR,
// taken as linear.
//
// Alpha is dropped, grey is spread over three channels.
// Errors  UserError(usage) naming the file; a picture over 32768 pixels a side is refused.
#pragma once

#include "renderer/film/film.h"

#include <filesystem>
#include <string_view>

namespace clients {

renderer::LinearImage read_picture(const std::filesystem::path& path);

// From bytes; `name` is for messages alone.
renderer::LinearImage read_pfm(std::string_view bytes, const std::string& name);

} // namespace clients
