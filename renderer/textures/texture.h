// Texture: a picture made ready to be looked up: a pyramid of levels, each half as wide as the one below, whose
// texels are the means, in linear light, of what they cover.
//
// Frame   u to the right, v upwards, the whole picture in [0, 1)^2.
// Units   linear light; codes are divided by the largest one, sRGB's are decoded unless they are alpha. Alpha is
//         not multiplied in.
// Filter  linear: between the four nearest texels of two levels, at up to kMostProbes places along the longer
//         axis of what a pixel sees, so that slanted surfaces stay sharp across it. nearest: the texel itself,
//         without levels.
// Source  L. Williams, "Pyramidal Parametrics", 1983; the probes after J. McCormack et al., "Feline", 1999.
// Memory  the first level is the Image itself, whose codes stay as compact as they came; the others take a third
//         more (codes of 16 bits become floats there).
// Threads immutable.
#pragma once

#include "renderer/color/rgb.h"
#include "renderer/description/texture.h"
#include "renderer/textures/image.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace renderer {

struct TexturePoint {
    double u = 0, v = 0;
};

// What a pixel sees of a surface, as an ellipse in u and v: both axes from end to end. Zero: a point.
struct TextureFootprint {
    TexturePoint long_axis{}, short_axis{};
};

struct Rgba {
    Rgb color{};
    float alpha = 1;
};

class Texture {
public:
    static constexpr int kMostProbes = 8;

    // `with_levels`: else it is only looked up at points, or by nearest texels.
    Texture(std::shared_ptr<const Image> image, TextureEncoding encoding, bool with_levels);

    // `at` is of the picture: already scaled. What is not finite counts as 0.
    Rgba
    lookup(TexturePoint at, TextureWrap wrap, TextureFilter filter, const TextureFootprint& footprint) const;

    bool has_alpha() const { return image_->has_alpha(); }
    std::uint64_t size_bytes() const; // without the Image

private:
    struct Level {
        std::uint32_t width, height;
        PixelType type;
        const std::byte* bytes;
    };
    void build_levels();
    Rgba fetch(const Level& level, std::size_t x, std::size_t y) const;
    Rgba bilinear(const Level& level, TexturePoint at, TextureWrap wrap) const;
    Rgba between_levels(double level, TexturePoint at, TextureWrap wrap) const;

    std::shared_ptr<const Image> image_;
    TextureEncoding encoding_;
    std::vector<Level> levels_;
    std::vector<Array<std::byte>> made_; // what the levels but the first lie in
};

// What `use` says, or what it leaves to the kind of picture and of value.
TextureEncoding encoding_of(const TextureUse& use, const Image& image, bool is_color);

} // namespace renderer
