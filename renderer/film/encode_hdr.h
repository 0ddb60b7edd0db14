// Radiance HDR: the linear picture as mantissas of 8 bits and one exponent a pixel, run-length coded.
//
// Values   rounded to the nearest mantissa, for readers that take it as it is (most; Radiance itself adds half a
//          step). What is negative or not a number becomes 0, what is too large the largest: 255 * 2^119.
// Source   G. Ward, "Real Pixels", Graphics Gems II (1991); the format of Radiance's ray/doc/filefmts.
// Texts    variables of the header: SOFTWARE=..., HELIOGRAPH=...; the primaries are those of Rec. 709.
#pragma once

#include "renderer/film/film.h"
#include "renderer/film/picture.h"

#include <cstdint>
#include <vector>

namespace renderer {

std::vector<std::uint8_t> encode_hdr(const LinearImage& image, const PictureTexts& texts = {});

} // namespace renderer
