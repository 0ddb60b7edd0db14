// Transcendental functions with the same bits on every processor.
//
// glibc 2.36 picks FMA variants of its double exp, sin, log, pow, atan2 at run time, and those round
// differently. The double functions here are built from +, -, *, / and sqrt alone, in a fixed order. The
// float ones forward to libm, whose float versions evaluate in double and were seen to give the same bits
// either way; a test holds that under GLIBC_TUNABLES.
//
// Errors  double: within 2 ulp over the ranges stated; NaN in, NaN out.
#pragma once

#include <utility>

namespace renderer {

inline constexpr double kPi = 3.14159265358979323846;

// {sin, cos} of an angle in degrees; exact at multiples of 90. |degrees| up to 1e15.
std::pair<double, double> sin_cos_deg(double degrees);
// {sin, cos} of an angle in radians, |radians| up to 1e5.
std::pair<double, double> sin_cos(double radians);
// The same for |radians| <= pi/4, without a reduction.
std::pair<double, double> sin_cos_near_zero(double radians);
// tan of an angle in degrees, within (-90, 90).
double tan_deg(double degrees);
// 2^x for |x| up to 1000; exact where x is an integer.
double exp2(double x);
// Base 2 logarithm of x > 0, also of subnormal x; -infinity at 0, NaN below. Within 3 ulp, absolute near 1.
double log2(double x);
// e^x, within 2 ulp; 0 below -745, infinity above 709.79.
double exp(double x);
// Natural logarithm, as log2.
double log(double x);
// Angle of (x, y) from the x axis in (-pi, pi], radians; 0 for (0, 0), NaN for infinities.
double atan2(double y, double x);
// Angle in [0, pi] of a cosine, which is clamped to [-1, 1].
double acos(double cosine);

// x^y for x >= 0, as std::pow(float, float) rounds it.
float pow(float x, float y);

} // namespace renderer
