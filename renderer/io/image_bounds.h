// Bounds that every reader of pictures keeps, and how it tells that one was passed.
#pragma once

#include "renderer/io/import_mesh.h"
#include "renderer/textures/image.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace renderer {

// Told before anything is allocated. `most_pixels`: that the bytes of the file can hold.
inline std::optional<ImportFault> over_image_bounds(std::string_view title,
                                                    std::uint64_t width,
                                                    std::uint64_t height,
                                                    std::uint64_t most_pixels,
                                                    const Limits& limits)
{
    constexpr std::uint64_t kMostSide = 1u << 24;
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width == 0 || height == 0)
        return ImportFault{"malformed", "the " + std::string(title) + " says that it has " + size};
    if (width > kMostSide || height > kMostSide || width * height > limits.texture_pixels)
        return ImportFault{"over_limit",
                           size + ", the limit is " + std::to_string(limits.texture_pixels) +
                               " (--limit-texture-pixels)"};
    if (width * height > most_pixels)
        return ImportFault{"truncated",
                           "the " + std::string(title) + " says that it has " + size +
                               ", which the bytes that are there cannot hold: send the file whole"};
    return std::nullopt;
}

inline Image empty_image(std::uint32_t width, std::uint32_t height, std::uint32_t channels, PixelType type)
{
    Image image{width, height, channels, type, {}};
    image.bytes.resize_for_overwrite(image.expected_bytes());
    return image;
}

} // namespace renderer
