#include "renderer/textures/image.h"

#include <cmath>
#include <cstring>

namespace renderer {

std::optional<std::string> validate_image(const Image& image)
{
    constexpr std::uint32_t kMostSide = 1u << 24; // so that no product here is beyond 64 bits
    if (image.width == 0 || image.height == 0 || image.width > kMostSide || image.height > kMostSide)
        return "its sides are " + std::to_string(image.width) + " and " + std::to_string(image.height);
    if (image.channels < 1 || image.channels > 4)
        return "it has " + std::to_string(image.channels) + " channels";
    if (image.type != PixelType::whole_8 && image.type != PixelType::whole_16 &&
        image.type != PixelType::real_32)
        return "its numbers are of no known type";
    if (image.bytes.size() != image.expected_bytes())
        return "it has " + std::to_string(image.bytes.size()) + " bytes instead of " +
               std::to_string(image.expected_bytes());
    if (image.type != PixelType::real_32) return std::nullopt;
    for (std::size_t at = 0; at < image.bytes.size(); at += sizeof(float)) {
        float value = 0;
        std::memcpy(&value, image.bytes.data() + at, sizeof value);
        if (!std::isfinite(value))
            return "number " + std::to_string(at / sizeof value) + " of it is not finite";
    }
    return std::nullopt;
}

} // namespace renderer
