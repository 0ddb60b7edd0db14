// encode_picture: a picture in one of the formats of description/picture_formats.h.
//
// PNG and JPEG hold what a display shows, exposed and toned; the others the radiance as it is;
// OpenEXR also the layers beside it.
// Errors  std::bad_alloc. A picture whose side is over the format's most_side_px is the caller's to refuse.
#pragma once

#include "renderer/description/picture_formats.h"
#include "renderer/film/picture.h"

#include <cstdint>
#include <vector>

namespace renderer {

std::vector<std::uint8_t> encode_picture(const Picture& picture, const PictureEncoding& encoding);

} // namespace renderer
