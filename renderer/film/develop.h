// Develop: from a linear picture to the codes that a display wants: exposure, tone curve, quantisation.
//
// Units   codes of 8 or 16 bits, three a pixel, top row first.
// Source  sRGB transfer function: IEC 61966-2-1; curves: tone.h.
// Errors  none: values are clamped to [0,1], those that are not finite become 0.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/film/film.h"

#include <cstdint>
#include <vector>

namespace renderer {

template <typename Code>
struct CodedImage {
    std::uint32_t width_px = 0, height_px = 0;
    std::vector<Code> rgb;
    bool srgb = true; // false: the numbers are linear
};
using Image8 = CodedImage<std::uint8_t>;
using Image16 = CodedImage<std::uint16_t>;

Image8 develop(const LinearImage& image, const ImageSettings& settings);
Image8 develop_8(const LinearImage& image, double exposure_ev, Tone tone);
Image16 develop_16(const LinearImage& image, double exposure_ev, Tone tone);

} // namespace renderer
