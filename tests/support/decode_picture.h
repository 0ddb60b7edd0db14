// Pictures for encoders, and what is read back by readers that are not ours: stb for PNG, JPEG and Radiance HDR,
// tinyexr for OpenEXR.
#pragma once

#include "renderer/film/film.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tests {

struct Decoded {
    int width_px = 0, height_px = 0, channels = 0;
    std::vector<float> values; // codes of 8 or 16 bits as they are
};

// No pixels: it could not be read.
Decoded decode_8(const std::vector<std::uint8_t>& bytes);  // PNG, JPEG
Decoded decode_16(const std::vector<std::uint8_t>& bytes); // PNG
Decoded decode_hdr(const std::vector<std::uint8_t>& bytes);

struct DecodedExr {
    int width_px = 0, height_px = 0;
    std::map<std::string, std::vector<float>> channels;
    std::map<std::string, std::string> texts; // attributes of type string
    std::string error;
};
DecodedExr decode_exr(const std::vector<std::uint8_t>& bytes);

// Radiance over many powers of two, smooth in parts, the same at every call.
renderer::LinearImage some_radiance(std::uint32_t width_px, std::uint32_t height_px);

} // namespace tests
