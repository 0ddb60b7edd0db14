#include "renderer/film/develop.h"

// The one place that compiles the encoder.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <array>
#include <stdexcept>
#include <string_view>

namespace renderer {

namespace {

constexpr std::size_t kAfterHeader = 8 + 25; // signature and IHDR: further chunks go here, before the pixels

// The encoder counts bytes in int and doubles its buffers.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;

// CRC-32 of PNG, annex D of its specification.
std::uint32_t crc_of(std::string_view bytes)
{
    std::uint32_t crc = 0xffffffffu;
    for (const char byte : bytes) {
        crc ^= static_cast<std::uint8_t>(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    return ~crc;
}

std::string big_endian(std::uint32_t value)
{
    return {static_cast<char>(value >> 24),
            static_cast<char>(value >> 16),
            static_cast<char>(value >> 8),
            static_cast<char>(value)};
}

std::string chunk(std::string_view type, std::string_view data)
{
    const std::string body = std::string(type) + std::string(data);
    return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(crc_of(body));
}

// Keyword, then: not compressed, method 0, no language tag, no translated keyword.
std::string text_chunk(const PngText& text)
{
    return chunk("iTXt", text.keyword + std::string(5, '\0') + text.text);
}

void append_bytes(void* context, void* data, int size)
{
    auto& out = *static_cast<std::vector<std::uint8_t>*>(context);
    const auto* const begin = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), begin, begin + size);
}

} // namespace

std::vector<std::uint8_t> encode_png(const Image8& image, std::span<const PngText> texts)
{
    if (std::size_t{image.height_px} * (image.width_px * std::size_t{3} + 1) > kMostBytes)
        throw std::runtime_error(
            "a picture of more than 1 GiB cannot be encoded as PNG: render it in regions, or as PFM");
    std::vector<std::uint8_t> png;
    const int width = static_cast<int>(image.width_px), height = static_cast<int>(image.height_px);
    if (stbi_write_png_to_func(append_bytes, &png, width, height, 3, image.rgb.data(), width * 3) == 0 ||
        png.size() <= kAfterHeader)
        throw std::runtime_error("cannot encode the picture as PNG");
    std::string extra;
    if (image.srgb) extra += chunk("sRGB", std::string_view("\0", 1)); // rendering intent: perceptual
    for (const PngText& text : texts)
        extra += text_chunk(text);
    png.insert(png.begin() + static_cast<std::ptrdiff_t>(kAfterHeader), extra.begin(), extra.end());
    return png;
}

} // namespace renderer
