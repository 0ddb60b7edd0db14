// Bounds on floating-point rounding, for those who must say how far a computed value can be off.
//
// Source  N. Higham, "Accuracy and Stability of Numerical Algorithms", section 3.1: n roundings in a row
//         change a value by a factor within 1 +- gamma(n).
#pragma once

#include "renderer/math/vec3.h"

#include <limits>

namespace renderer {

template <typename T>
constexpr T gamma(int n)
{
    constexpr T unit = std::numeric_limits<T>::epsilon() / 2;
    return (static_cast<T>(n) * unit) / (1 - static_cast<T>(n) * unit);
}

// Largest magnitude among the three components.
template <typename T>
constexpr T max_abs(Vec3<T> v)
{
    return max_component(abs(v));
}

} // namespace renderer
