// One reader for each format of pictures; import_image() chooses.
#pragma once

#include "renderer/io/import_image.h"

namespace renderer {

// By libpng, after a walk over the chunks: they fit, hold enough, and end. Palettes become colours, 1 to 4 bits
// become 8, a transparent colour becomes alpha; 16 bits stay.
ImageResult read_png(std::span<const std::byte> bytes, const Limits& limits);

// By stb, which fills what is missing with grey: a walk over the segments first sees to it that nothing is, and
// that the number of scans is bounded.
ImageResult read_jpeg(std::span<const std::byte> bytes, const Limits& limits);

// Of our own. Source: G. Ward, "Real Pixels", Graphics Gems II, 1991, and the format's old and new run lengths.
ImageResult read_hdr(std::span<const std::byte> bytes, const Limits& limits);

// Of our own: types 1, 2, 3, 9, 10 and 11, 8 bits a channel. Source: Truevision TGA file format
// specification 2.0.
ImageResult read_tga(std::span<const std::byte> bytes, const Limits& limits);

// Whether the header is one that read_tga() knows: the format has no mark.
bool is_tga(std::span<const std::byte> bytes);

} // namespace renderer
