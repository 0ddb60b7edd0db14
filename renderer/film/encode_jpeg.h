// JPEG: codes of 8 bits, each channel at full resolution (4:4:4), quality 92, baseline; texts as comments, one
// each.
//
// A reader takes the codes for sRGB: the format has no other word without a profile.
// Source  ITU-T T.81, JFIF 1.02. The integer transform gives the same bytes with and without vectors.
// Errors  std::runtime_error if the picture has no pixels or a side over 65500; std::bad_alloc.
#pragma once

#include "renderer/film/develop.h"
#include "renderer/film/picture.h"

#include <cstdint>
#include <vector>

namespace renderer {

std::vector<std::uint8_t> encode_jpeg(const Image8& image, const PictureTexts& texts = {});

} // namespace renderer
