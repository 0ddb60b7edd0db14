// Textured values: a number or a colour that a picture may give point by point.
#pragma once

#include "renderer/color/rgb.h"

#include <cstdint>
#include <optional>

namespace renderer {

enum class TextureWrap : std::uint8_t { repeat, clamp, mirror };
enum class TextureFilter : std::uint8_t { linear, nearest };
enum class TextureEncoding : std::uint8_t { srgb, linear };

// A picture on a surface: u to its right, v upwards, the whole of it in [0, 1)^2 of the mesh's coordinates times
// `scale`.
struct TextureUse {
    std::uint32_t image = 0; // index into SceneDescription::images
    double scale_u = 1, scale_v = 1;
    TextureWrap wrap = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    std::optional<TextureEncoding> encoding{}; // nothing: srgb for colours of 8 or 16 bits, else linear
    std::uint8_t channel = 0;                  // of a number: 0 red or grey, 1 green, 2 blue, 3 alpha
    friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

// `value` where there is no texture; with one, its place is taken by the picture's.
template <typename T>
struct Textured {
    T value{};
    std::optional<TextureUse> texture{};
    friend bool operator==(const Textured&, const Textured&) = default;
};
using TexturedColor = Textured<Rgb>;
using TexturedNumber = Textured<double>;

} // namespace renderer
