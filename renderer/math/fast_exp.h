// fast_exp: e^x inline, for sums over light paths through air, which take it a million times a picture.
//
// Built from +, -, * alone, so it has the same bits on every processor.
//
// Errors  within 2 ulp for x in [-708, 709]; 0 below (no subnormal numbers), infinity above; NaN for NaN.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace renderer {

inline double fast_exp(double x)
{
    if (!(x >= -708.0)) return x < -708.0 ? 0.0 : x;
    if (x > 709.0) return std::numeric_limits<double>::infinity();
    // x = n ln 2 + y. Adding 1.5 * 2^52 rounds to a whole number and leaves it in the low bits.
    constexpr double kShift = 6755399441055744.0;
    constexpr double kLn2High = 0x1.62e42fefap-1, kLn2Low = 0x1.cf79abc9e3b39p-40;
    const double shifted = x * 1.4426950408889634074 + kShift;
    const double n = shifted - kShift;
    const double y = (x - n * kLn2High) - n * kLn2Low;
    // Taylor, |y| <= 0.347: the first term left out is below 4e-18. Two halves of it at once.
    const double z = y * y;
    double even = 1.0 / 479001600.0, odd = 1.0 / 6227020800.0;
    even = even * z + 1.0 / 3628800.0;
    odd = odd * z + 1.0 / 39916800.0;
    even = even * z + 1.0 / 40320.0;
    odd = odd * z + 1.0 / 362880.0;
    even = even * z + 1.0 / 720.0;
    odd = odd * z + 1.0 / 5040.0;
    even = even * z + 1.0 / 24.0;
    odd = odd * z + 1.0 / 120.0;
    even = even * z + 0.5;
    odd = odd * z + 1.0 / 6.0;
    const double p = 1 + (y + (z * even + y * z * odd));
    const auto bits = std::bit_cast<std::uint64_t>(shifted) + 1023u;
    return p * std::bit_cast<double>(bits << 52);
}

} // namespace renderer
