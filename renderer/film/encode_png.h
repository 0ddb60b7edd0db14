// PNG: codes of 8 or 16 bits a channel, marked as sRGB if they are, else as linear (gAMA 1); texts as iTXt chunks.
//
// Source  W3C REC-PNG-20031110.
// Errors  std::runtime_error if the picture has no pixels; std::bad_alloc. The same pixels and texts give the
//         same bytes.
#pragma once

#include "renderer/film/develop.h"
#include "renderer/film/picture.h"

#include <cstdint>
#include <vector>

namespace renderer {

std::vector<std::uint8_t> encode_png(const Image8& image, const PictureTexts& texts = {});
std::vector<std::uint8_t> encode_png(const Image16& image, const PictureTexts& texts = {});

} // namespace renderer
