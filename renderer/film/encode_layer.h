// encode_layer: a layer beside a picture as a file of its own.
//
// OpenEXR and PFM hold its numbers as they are; PNG codes of them, where description/layers.h says so: normals as
// (n + 1) / 2, linear; the albedo as sRGB, what is over 1 as 1.
// Errors  std::bad_alloc. A format that does not hold the layer is the caller's to refuse.
#pragma once

#include "renderer/description/picture_formats.h"
#include "renderer/film/picture.h"

#include <cstdint>
#include <vector>

namespace renderer {

// One of `picture.layers`.
std::vector<std::uint8_t>
encode_layer(const Picture& picture, const LayerImage& layer, const PictureEncoding& encoding);

} // namespace renderer
