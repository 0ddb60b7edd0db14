// arc_cosine: an angle good enough to find a place in a table.
//
// Errors  within 3e-7 rad, 0 <= angle <= pi; x is cut to [-1, 1].
// Source  Abramowitz, Stegun 1964, 4.4.46.
#pragma once

#include <cmath>

namespace renderer {

inline float arc_cosine(float x)
{
    const float a = x < 0 ? -x : x;
    float p = -0.0012624911f;
    p = p * a + 0.0066700901f;
    p = p * a - 0.0170881256f;
    p = p * a + 0.0308918810f;
    p = p * a - 0.0501743046f;
    p = p * a + 0.0889789874f;
    p = p * a - 0.2145988016f;
    p = p * a + 1.5707963050f;
    const float angle = a < 1 ? std::sqrt(1 - a) * p : 0.0f;
    return x < 0 ? 3.14159265f - angle : angle;
}

} // namespace renderer
