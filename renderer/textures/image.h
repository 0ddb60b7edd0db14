// Image: a picture as it came out of a file, decoded and checked: the imported form, before any filtering.
//
// Layout  rows from the top, pixels from the left, channels together: grey, grey and alpha, RGB or RGBA, alpha
//         not multiplied in. Whole numbers are codes of the file, as it encoded them; floats are linear light.
// Promise of an Image that validate_image() passed: it has pixels, the array has just the bytes of them, and
//         every float is finite.
// Threads immutable when shared.
#pragma once

#include "renderer/math/array.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace renderer {

enum class PixelType : std::uint8_t { whole_8, whole_16, real_32 };

constexpr std::size_t bytes_of(PixelType type)
{
    return type == PixelType::whole_8 ? 1 : type == PixelType::whole_16 ? 2 : 4;
}

struct Image {
    std::uint32_t width = 0, height = 0;
    std::uint32_t channels = 0; // 1 to 4
    PixelType type = PixelType::whole_8;
    Array<std::byte> bytes; // whole_16 and real_32: in this machine's byte order, at a multiple of 4

    bool has_alpha() const { return channels == 2 || channels == 4; }
    std::uint64_t pixels() const { return std::uint64_t{width} * height; }
    std::uint64_t expected_bytes() const { return pixels() * channels * bytes_of(type); }
};

// What is wrong with it, if anything is.
std::optional<std::string> validate_image(const Image& image);

} // namespace renderer
