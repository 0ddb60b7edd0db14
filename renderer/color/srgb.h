// sRGB: the transfer function between linear light and the numbers that a display wants.
//
// Units   both sides in [0,1]; values outside are clamped, NaN becomes 0.
// Source  IEC 61966-2-1; the constants of its amendment 1 (threshold 0.0031308).
#pragma once

#include <cstdint>

namespace renderer {

float srgb_from_linear(float linear);
float linear_from_srgb(float encoded);

// The nearest of 256 or 65536 equally spaced codes: round(value * 255), round(value * 65535).
std::uint8_t quantise_8(float value);
std::uint16_t quantise_16(float value);

// quantise_8(srgb_from_linear(linear)), to the bit and without a power: a few nanoseconds.
std::uint8_t srgb_8_from_linear(float linear);
std::uint16_t srgb_16_from_linear(float linear); // with a power

} // namespace renderer
