#include "renderer/color/srgb.h"

#include "renderer/math/transcendental.h"

#include <cmath>

namespace renderer {

namespace {

float clamp_unit(float x)
{
    return x > 0 ? (x < 1 ? x : 1.0f) : 0.0f; // NaN fails the first comparison
}

} // namespace

float srgb_from_linear(float linear)
{
    const float x = clamp_unit(linear);
    if (x <= 0.0031308f) return 12.92f * x;
    // In double, so that 1 stays 1.
    return clamp_unit(static_cast<float>(1.055 * static_cast<double>(pow(x, 1.0f / 2.4f)) - 0.055));
}

float linear_from_srgb(float encoded)
{
    const float x = clamp_unit(encoded);
    return x <= 0.04045f ? x / 12.92f : clamp_unit(pow((x + 0.055f) / 1.055f, 2.4f));
}

std::uint8_t quantise_8(float value)
{
    return static_cast<std::uint8_t>(std::lround(clamp_unit(value) * 255.0f));
}

} // namespace renderer
