// OpenEXR: channels of 32-bit floats by name, scan lines of one part, ZIP compression: every bit of the picture.
//
// Channels may be many and of any name. Texts become attributes of type string.
// Source  "OpenEXR File Layout" and ImfZip.cpp of the OpenEXR project, for the order of the bytes that are
//         deflated. Blocks of 16 lines that do not get smaller are kept as they are, as the format has it.
// Errors  std::bad_alloc. The same channels and texts give the same bytes.
#pragma once

#include "renderer/film/picture.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace renderer {

// Values `stride` floats apart, a row after the other, top row first.
struct ExrChannel {
    std::string name; // 1 to 255 bytes: "R", "depth.Z"
    const float* values = nullptr;
    std::size_t stride = 1;
};

std::vector<std::uint8_t> encode_exr(std::uint32_t width_px,
                                     std::uint32_t height_px,
                                     std::vector<ExrChannel> channels,
                                     const PictureTexts& texts = {});

// R, G and B.
std::vector<ExrChannel> exr_channels(const LinearImage& image);
// The layer's own, each name behind `prefix`.
std::vector<ExrChannel> exr_channels(const LayerImage& layer, std::string_view prefix);
// All of a picture's: R, G, B and those of its layers, by the names that description/layers.h has for them there.
std::vector<ExrChannel> exr_channels(const Picture& picture);

} // namespace renderer
