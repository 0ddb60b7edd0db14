#include "renderer/film/encode_pfm.h"

#include "renderer/film/append_bytes.h"

#include <string>

namespace renderer {

std::vector<std::uint8_t>
encode_pfm(std::uint32_t width_px, std::uint32_t height_px, std::span<const float> values)
{
    const std::size_t pixels = std::size_t{width_px} * height_px;
    const bool colour = values.size() != pixels;
    Bytes bytes;
    bytes.reserve(64 + values.size_bytes());
    append_text(bytes,
                std::string(colour ? "PF" : "Pf") + "\n" + std::to_string(width_px) + " " +
                    std::to_string(height_px) + "\n-1.0\n");
    const std::size_t row_values = std::size_t{width_px} * (colour ? 3 : 1);
    for (std::size_t row = height_px; row-- > 0;)
        for (const float value : values.subspan(row * row_values, row_values))
            append_float(bytes, value);
    return bytes;
}

std::vector<std::uint8_t> encode_pfm(const LinearImage& image)
{
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    const auto* channels = reinterpret_cast<const float*>(image.pixels.data());
    return encode_pfm(image.width_px, image.height_px, {channels, image.pixels.size() * 3});
}

} // namespace renderer
