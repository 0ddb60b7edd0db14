#include "renderer/film/tone.h"

namespace renderer {

namespace {

// Where f is 0.18, over 0.18: the positive root of (2.51 - 0.18 * 2.43) x^2 + (0.03 - 0.18 * 0.59) x - 0.18 * 0.14.
constexpr double kMiddleGrey = 0.7231708051011695;

// f passes 1 at 7.242 and would go on to 1.033.
constexpr double kBeyondWhite = 1e3;

float unit(double x)
{
    return x > 0 ? (x < 1 ? static_cast<float>(x) : 1.0f) : 0.0f; // NaN fails the first comparison
}

} // namespace

float filmic(double linear)
{
    const double x = linear * kMiddleGrey;
    if (!(x > 0)) return 0.0f;
    if (x > kBeyondWhite) return 1.0f;
    return unit(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
}

float toned(double linear, Tone tone)
{
    switch (tone) {
    case Tone::srgb:
    case Tone::linear:
        return unit(linear);
    case Tone::filmic:
        return filmic(linear);
    }
    return 0.0f;
}

} // namespace renderer
