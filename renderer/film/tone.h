// Tone curves: what becomes of exposed linear light before it is quantised.
//
// Units   in: linear, infinite too; out: [0, 1]. NaN and what is negative become 0.
// Source  filmic: the fit of the ACES reference curve by K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2016),
//         f(x) = x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), channel by channel. Ours differs in one thing:
//         light is scaled first so that middle grey, 0.18, stays 0.18, and another curve is not another
//         exposure. White is reached at 10.01.
#pragma once

#include "renderer/description/settings.h"

namespace renderer {

// Linear light for a display; the sRGB transfer function comes after it.
float filmic(double linear);

// Under the curve. Encoding as sRGB, where the curve wants it, is the quantiser's.
float toned(double linear, Tone tone);

// Whether the codes are those of sRGB; else they are the numbers themselves.
constexpr bool is_srgb(Tone tone)
{
    return tone != Tone::linear;
}

} // namespace renderer
