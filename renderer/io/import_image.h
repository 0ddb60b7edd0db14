// import_image: reads a picture of any format of image_formats.h into an Image, and trusts no byte of it.
//
// Check    of each file before anything is allocated for its pixels: its size against the limit, whether the
//          bytes there are can hold them, whether it is whole. What is animated is refused, not half shown.
// Errors   faults are values with a plain sentence: "unknown_format", "truncated", "malformed", "unsupported",
//          "over_limit". Throws std::bad_alloc alone. Services import in a process of its own.
// Left out colour profiles, gamma and EXIF's turns: pictures are taken as sRGB or linear, as they lie.
// Cost     linear in the file and its pixels; memory of twice the pixels at most.
#pragma once

#include "renderer/io/import_mesh.h"
#include "renderer/textures/image.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace renderer {

struct ImportedImage {
    Image image;
    std::string format; // its name in image_formats.h
};

using ImageResult = std::variant<ImportedImage, ImportFault>;

// The format is told from the content; TGA, which has no mark, from the name's extension.
ImageResult import_image(std::string_view name, std::span<const std::byte> bytes, const Limits& limits);

// Whether the bytes begin as a picture does, of a format that is read or of one that is known by sight.
bool looks_like_image(std::string_view name, std::span<const std::byte> bytes);

} // namespace renderer
