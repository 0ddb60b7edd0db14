#include "tests/support/decode_picture.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#include <stb_image.h>
#pragma GCC diagnostic pop
#include <cmath>
#include <cstddef>
#include <tinyexr.h>

namespace tests {

namespace {

template <typename Value>
Decoded taken(Value* values, Decoded decoded)
{
    if (values == nullptr) return {};
    decoded.values.assign(values,
                          values + static_cast<std::ptrdiff_t>(decoded.width_px) * decoded.height_px *
                                       decoded.channels);
    stbi_image_free(values);
    return decoded;
}

// Of a file whose header was read.
void take_channels(const EXRHeader& header, const EXRImage& image, DecodedExr& decoded)
{
    decoded.width_px = image.width;
    decoded.height_px = image.height;
    const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (int c = 0; c < header.num_channels; ++c) {
        const auto* values = reinterpret_cast<const float*>(image.images[c]);
        decoded.channels[header.channels[c].name].assign(values, values + pixels);
    }
    for (int a = 0; a < header.num_custom_attributes; ++a) {
        const EXRAttribute& attribute = header.custom_attributes[a];
        if (std::string(attribute.type) == "string")
            decoded.texts[attribute.name] = {reinterpret_cast<const char*>(attribute.value),
                                             static_cast<std::size_t>(attribute.size)};
    }
}

} // namespace

Decoded decode_8(const std::vector<std::uint8_t>& bytes)
{
    Decoded d;
    auto* values = stbi_load_from_memory(
        bytes.data(), static_cast<int>(bytes.size()), &d.width_px, &d.height_px, &d.channels, 0);
    return taken(values, d);
}

Decoded decode_16(const std::vector<std::uint8_t>& bytes)
{
    Decoded d;
    if (!stbi_is_16_bit_from_memory(bytes.data(), static_cast<int>(bytes.size()))) return {};
    auto* values = stbi_load_16_from_memory(
        bytes.data(), static_cast<int>(bytes.size()), &d.width_px, &d.height_px, &d.channels, 0);
    return taken(values, d);
}

Decoded decode_hdr(const std::vector<std::uint8_t>& bytes)
{
    Decoded d;
    if (!stbi_is_hdr_from_memory(bytes.data(), static_cast<int>(bytes.size()))) return {};
    auto* values = stbi_loadf_from_memory(
        bytes.data(), static_cast<int>(bytes.size()), &d.width_px, &d.height_px, &d.channels, 0);
    return taken(values, d);
}

DecodedExr decode_exr(const std::vector<std::uint8_t>& bytes)
{
    DecodedExr decoded;
    EXRVersion version;
    EXRHeader header;
    EXRImage image;
    InitEXRHeader(&header);
    InitEXRImage(&image);
    const char* error = nullptr;
    bool good =
        ParseEXRVersionFromMemory(&version, bytes.data(), bytes.size()) == TINYEXR_SUCCESS &&
        ParseEXRHeaderFromMemory(&header, &version, bytes.data(), bytes.size(), &error) == TINYEXR_SUCCESS;
    good = good &&
           LoadEXRImageFromMemory(&image, &header, bytes.data(), bytes.size(), &error) == TINYEXR_SUCCESS;
    if (good) take_channels(header, image, decoded);
    if (!good) decoded.error = error != nullptr ? error : "not an EXR file";
    if (error != nullptr) FreeEXRErrorMessage(error);
    FreeEXRImage(&image);
    FreeEXRHeader(&header);
    return decoded;
}

renderer::LinearImage some_radiance(std::uint32_t width_px, std::uint32_t height_px)
{
    renderer::LinearImage image{width_px, height_px, {}};
    for (std::uint32_t y = 0; y < height_px; ++y)
        for (std::uint32_t x = 0; x < width_px; ++x) {
            const bool flat = (x / 9 + y / 5) % 3 == 0; // runs as well as what is none
            const float v = flat ? 0.75f
                                 : std::ldexp(1.0f + static_cast<float>(x * 7 + y * 13) / 997.0f,
                                              static_cast<int>((x * 5 + y) % 40) - 20);
            image.pixels.push_back({v, v / 3, flat ? 0.0f : v * 2});
        }
    return image;
}

} // namespace tests
