// PFM, the portable float map: every bit of the linear picture, and no place for texts.
//
// Little-endian, rows from the bottom as the format wants; three channels (PF) or one (Pf).
#pragma once

#include "renderer/film/film.h"

#include <cstdint>
#include <span>
#include <vector>

namespace renderer {

std::vector<std::uint8_t> encode_pfm(const LinearImage& image);
// One or three channels a pixel, top row first.
std::vector<std::uint8_t>
encode_pfm(std::uint32_t width_px, std::uint32_t height_px, std::span<const float> values);

} // namespace renderer
