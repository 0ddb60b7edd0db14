#include "renderer/film/develop.h"

#include "renderer/color/srgb.h"
#include "renderer/math/transcendental.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace renderer {

namespace {

float finite_or_black(double x)
{
    return std::isfinite(x) ? static_cast<float>(std::clamp(x, 0.0, 1.0)) : 0.0f;
}

void append_float(std::vector<std::uint8_t>& bytes, float value)
{
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
}

} // namespace

Image8 develop(const LinearImage& image, const ImageSettings& settings)
{
    Image8 out{image.width_px, image.height_px, {}, settings.tone == Tone::srgb};
    out.rgb.resize(image.pixels.size() * 3);
    const double exposure = exp2(std::clamp(settings.exposure_ev, -1000.0, 1000.0));
    const auto code = out.srgb ? srgb_8_from_linear : quantise_8;
    std::uint8_t* to = out.rgb.data();
    for (const Rgb& pixel : image.pixels)
        for (const float channel : {pixel.r, pixel.g, pixel.b})
            *to++ = code(finite_or_black(static_cast<double>(channel) * exposure));
    return out;
}

std::vector<std::uint8_t> encode_pfm(const LinearImage& image)
{
    const std::string header =
        "PF\n" + std::to_string(image.width_px) + " " + std::to_string(image.height_px) + "\n-1.0\n";
    std::vector<std::uint8_t> bytes(header.begin(), header.end());
    bytes.reserve(bytes.size() + image.pixels.size() * 12);
    for (std::uint32_t row = image.height_px; row-- > 0;) {
        for (std::uint32_t x = 0; x < image.width_px; ++x) {
            const Rgb& pixel = image.pixels[std::size_t{row} * image.width_px + x];
            append_float(bytes, pixel.r);
            append_float(bytes, pixel.g);
            append_float(bytes, pixel.b);
        }
    }
    return bytes;
}

} // namespace renderer
