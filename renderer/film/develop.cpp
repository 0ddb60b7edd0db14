#include "renderer/film/develop.h"

#include "renderer/color/srgb.h"
#include "renderer/film/tone.h"
#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

template <typename Code>
CodedImage<Code> code(const LinearImage& image, double exposure_ev, Tone tone, Code (*quantise)(float))
{
    CodedImage<Code> out{image.width_px, image.height_px, {}, is_srgb(tone)};
    out.rgb.resize(image.pixels.size() * 3);
    const double exposure = exp2(std::clamp(exposure_ev, -1000.0, 1000.0));
    Code* to = out.rgb.data();
    for (const Rgb& pixel : image.pixels)
        for (const float channel : {pixel.r, pixel.g, pixel.b})
            *to++ = quantise(std::isfinite(channel) ? toned(static_cast<double>(channel) * exposure, tone)
                                                    : 0.0f);
    return out;
}

} // namespace

Image8 develop_8(const LinearImage& image, double exposure_ev, Tone tone)
{
    return code(image, exposure_ev, tone, is_srgb(tone) ? srgb_8_from_linear : quantise_8);
}

Image16 develop_16(const LinearImage& image, double exposure_ev, Tone tone)
{
    return code(image, exposure_ev, tone, is_srgb(tone) ? srgb_16_from_linear : quantise_16);
}

Image8 develop(const LinearImage& image, const ImageSettings& settings)
{
    return develop_8(image, settings.exposure_ev.value_or(0), settings.tone);
}

} // namespace renderer
