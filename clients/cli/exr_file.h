// OpenEXR files as linear pictures: the channels R, G and B, or Y, of one part; halves and floats.
//
// Read by tinyexr, which is no parser for strangers' files: this is for pictures of one's own.
// Errors  UserError(usage) naming the file.
#pragma once

#include "renderer/film/film.h"

#include <string>
#include <string_view>

namespace clients {

bool is_exr(std::string_view bytes);
renderer::LinearImage read_exr(std::string_view bytes, const std::string& name);

} // namespace clients
