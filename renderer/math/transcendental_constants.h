// What the elementary functions of one number and of vectors share: coefficients, from the highest power down, and parts
// of angles. See transcendental.cpp for what they are good for.
#pragma once

namespace renderer::transcendental {

// Adding it rounds to a whole number, and leaves that in the low bits: 1.5 * 2^52.
inline constexpr double kShift = 6755399441055744.0;

// pi/2 in three parts of at most 33 bits: their products with a quarter count below 2^20 are exact.
// Source: Cody, Waite, "Software Manual for the Elementary Functions", 1980, ch. 8.
inline constexpr double kQuarterTurn[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};

// Taylor polynomials in x^2 of (sin x - x) / x^3 and (cos x - 1 + x^2 / 2) / x^4: on |x| <= pi/4 the first term left out is
// below 1e-20, so rounding is the only error.
inline constexpr double kSine[] = {-1.0 / 121645100408832000.0, // -1/19!
                                   1.0 / 355687428096000.0,     // 1/17!
                                   -1.0 / 1307674368000.0,
                                   1.0 / 6227020800.0,
                                   -1.0 / 39916800.0,
                                   1.0 / 362880.0,
                                   -1.0 / 5040.0,
                                   1.0 / 120.0,
                                   -1.0 / 6.0};
inline constexpr double kCosine[] = {1.0 / 2432902008176640000.0, // 1/20!
                                     -1.0 / 6402373705728000.0,   // -1/18!
                                     1.0 / 20922789888000.0,
                                     -1.0 / 87178291200.0,
                                     1.0 / 479001600.0,
                                     -1.0 / 3628800.0,
                                     1.0 / 40320.0,
                                     -1.0 / 720.0,
                                     1.0 / 24.0};

// atan at the multiples of 1/8, and (atan t - t) / t^3 in t^2: on |t| <= 1/16 t^17 / 17 is below 1e-21.
inline constexpr double kArcOfEighths[] = {0,
                                           0.1243549945467614350313548,
                                           0.2449786631268641541720825,
                                           0.3587706702705722203959201,
                                           0.4636476090008061162142562,
                                           0.5585993153435624359715082,
                                           0.6435011087932843868028092,
                                           0.7188299996216245054170142,
                                           0.7853981633974483096156608};
inline constexpr double kArc[] = {-1.0 / 15, 1.0 / 13, -1.0 / 11, 1.0 / 9, -1.0 / 7, 1.0 / 5, -1.0 / 3};

} // namespace renderer::transcendental
