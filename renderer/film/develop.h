// Develop: from a linear picture to bytes: exposure, tone curve, quantisation, PNG.
//
// Source  sRGB transfer function: IEC 61966-2-1; PNG: W3C REC-PNG-20031110.
// Errors  encode_png throws std::runtime_error if the encoder fails (out of memory); values are clamped to
//         [0,1], non-finite ones become 0.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/film/film.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace renderer {

struct Image8 {
    std::uint32_t width_px = 0, height_px = 0;
    std::vector<std::uint8_t> rgb; // 3 bytes a pixel, top row first
    bool srgb = true;              // false: the numbers are linear
};

Image8 develop(const LinearImage& image, const ImageSettings& settings);

// A line of text carried in the PNG (an iTXt chunk, UTF-8).
struct PngText {
    std::string keyword; // 1 to 79 Latin letters
    std::string text;
};

// PNG of 8 bits a channel, marked as sRGB if it is. The same pixels and texts give the same bytes.
std::vector<std::uint8_t> encode_png(const Image8& image, std::span<const PngText> texts = {});

// Portable float map (little-endian, linear, rows bottom to top as the format wants).
std::vector<std::uint8_t> encode_pfm(const LinearImage& image);

} // namespace renderer
