#include "renderer/math/transcendental.h"

#include "renderer/math/transcendental_constants.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace renderer {

namespace {

// By whether something is so: angles are as good as random, and a branch that cannot be foreseen costs more than these
// functions' arithmetic.
constexpr double kSign[2] = {1, -1};

using transcendental::kShift;

template <std::size_t N>
double polynomial(double z, const double (&coefficients)[N])
{
    double p = coefficients[0];
    for (std::size_t i = 1; i < N; ++i)
        p = p * z + coefficients[i];
    return p;
}

double sin_kernel(double x)
{
    const double z = x * x;
    return x + x * (z * polynomial(z, transcendental::kSine));
}

double cos_kernel(double x)
{
    const double z = x * x;
    // 1 - z/2 first, with what its rounding lost, so that the sum is right to an ulp near 1/sqrt(2).
    const double half = 0.5 * z;
    const double w = 1 - half;
    return w + (((1 - w) - half) + z * z * polynomial(z, transcendental::kCosine));
}

// sin and cos of (x + low) turned by `quarters` right angles.
std::pair<double, double> turned(double x, double low, int quarters)
{
    const double s0 = sin_kernel(x), c0 = cos_kernel(x);
    const double either[2] = {s0 + low * c0, c0 - low * s0};
    const auto quarter = static_cast<unsigned>(quarters) & 3;
    return {kSign[quarter >> 1] * either[quarter & 1],
            kSign[(quarter ^ (quarter >> 1)) & 1] * either[1 - (quarter & 1)]};
}

} // namespace

std::pair<double, double> sin_cos_deg(double degrees)
{
    if (!std::isfinite(degrees))
        return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    const double turn = std::fmod(degrees, 360.0); // exact
    const double quarters = std::rint(turn / 90);
    const double rest =
        turn - 90 * quarters; // exact: both are multiples of turn's last place and close together
    // pi/180 in two parts, the upper one short enough that its product with the upper half of `rest` is
    // exact.
    constexpr double kHigh = 0x1.1df46ap-6, kLow = kPi / 180 - kHigh, kLowest = 2.9486522708701687e-19;
    const double rest_high = static_cast<double>(static_cast<float>(rest)), rest_low = rest - rest_high;
    const double exact = rest_high * kHigh;
    const double correction = rest_low * kHigh + rest * kLow + rest * kLowest;
    const double x = exact + correction;
    return turned(x, correction - (x - exact), static_cast<int>(quarters));
}

std::pair<double, double> sin_cos(double radians)
{
    constexpr const auto& parts = transcendental::kQuarterTurn;
    const double shifted = radians * (2 / kPi) + kShift, quarters = shifted - kShift;
    const double first = radians - quarters * parts[0];
    const double second = quarters * parts[1];
    const double y = first - second;
    const double lost = (first - y) - second;
    const double tail = lost - quarters * parts[2];
    const double x = y + tail;
    return turned(x, (y - x) + tail, static_cast<int>(std::bit_cast<std::uint64_t>(shifted) & 3));
}

std::pair<double, double> sin_cos_near_zero(double radians)
{
    return {sin_kernel(radians), cos_kernel(radians)};
}

double tan_deg(double degrees)
{
    const auto [s, c] = sin_cos_deg(degrees);
    return s / c;
}

double exp2(double x)
{
    const double whole = std::rint(x);
    const double y = (x - whole) * 0.69314718055994530942;
    // 1 + y/1 (1 + y/2 (1 + y/3 ...)): on |y| <= 0.35 the first term left out is below 1e-19.
    double p = 1;
    for (int n = 15; n >= 2; --n)
        p = 1 + y * p / n;
    return std::ldexp(1 + y * p, static_cast<int>(whole));
}

// x = m 2^e with m in [sqrt(1/2), sqrt(2)); log m = 2 atanh((m - 1) / (m + 1)) by its series.
double log2(double x)
{
    if (!(x > 0) || !std::isfinite(x))
        return x == 0  ? -std::numeric_limits<double>::infinity()
               : x > 0 ? x
                       : std::numeric_limits<double>::quiet_NaN();
    int exponent = 0;
    double m = std::frexp(x, &exponent);
    if (m < 0.70710678118654752440) {
        m *= 2;
        --exponent;
    }
    const double s = (m - 1) / (m + 1), z = s * s; // z <= 0.0295: z^13 / 27 is below 1e-21
    double p = 1.0 / 25;
    p = p * z + 1.0 / 23;
    p = p * z + 1.0 / 21;
    p = p * z + 1.0 / 19;
    p = p * z + 1.0 / 17;
    p = p * z + 1.0 / 15;
    p = p * z + 1.0 / 13;
    p = p * z + 1.0 / 11;
    p = p * z + 1.0 / 9;
    p = p * z + 1.0 / 7;
    p = p * z + 1.0 / 5;
    p = p * z + 1.0 / 3;
    constexpr double kTwoOverLn2 = 2.8853900817779268147;
    return static_cast<double>(exponent) + (s + s * (z * p)) * kTwoOverLn2;
}

double exp(double x)
{
    if (!(x >= -746)) return x < 0 ? 0 : x; // NaN stays
    if (x > 710) return std::numeric_limits<double>::infinity();
    constexpr double kOneOverLn2 = 1.4426950408889634074;
    constexpr double kLn2High = 0x1.62e42fefap-1; // its product with a count of 11 bits is exact
    constexpr double kLn2Low = 0x1.cf79abc9e3b39803p-40;
    const double count = std::rint(x * kOneOverLn2);
    const double high = x - count * kLn2High, low = count * kLn2Low;
    const double y = high - low;      // |y| <= 0.35: the first term left out of the series is below 1e-18
    double p = 1.0 / 1307674368000.0; // 1/15!
    p = p * y + 1.0 / 87178291200.0;
    p = p * y + 1.0 / 6227020800.0;
    p = p * y + 1.0 / 479001600.0;
    p = p * y + 1.0 / 39916800.0;
    p = p * y + 1.0 / 3628800.0;
    p = p * y + 1.0 / 362880.0;
    p = p * y + 1.0 / 40320.0;
    p = p * y + 1.0 / 5040.0;
    p = p * y + 1.0 / 720.0;
    p = p * y + 1.0 / 120.0;
    p = p * y + 1.0 / 24.0;
    p = p * y + 1.0 / 6.0;
    p = p * y + 0.5;
    const double lost = (high - y) - low; // what the rounding of y left
    return std::ldexp(1 + (y + (y * y * p + lost)), static_cast<int>(count));
}

double log(double x)
{
    return log2(x) * 0.69314718055994530942;
}

namespace {

// atan of x in [0, 1]: from the nearest multiple of 1/8, by the series of the angle between.
double atan_unit(double x)
{
    const double nearest = (x * 8 + kShift) - kShift;
    const double c = nearest / 8;
    const double t = (x - c) / (1 + x * c), z = t * t; // |t| <= 1/16
    return transcendental::kArcOfEighths[static_cast<int>(nearest)] +
           (t + t * (z * polynomial(z, transcendental::kArc)));
}

} // namespace

double atan2(double y, double x)
{
    const double ax = std::abs(x), ay = std::abs(y);
    if (!std::isfinite(ax + ay)) return std::numeric_limits<double>::quiet_NaN();
    if (ax + ay == 0) return 0;
    constexpr double kRightAngle[2] = {0, kPi / 2}, kHalfTurn[2] = {0, kPi};
    const bool steep = ay > ax, behind = x < 0, below = y < 0;
    const double within = atan_unit(std::min(ax, ay) / std::max(ax, ay));
    const double ahead = kRightAngle[steep] + kSign[steep] * within;
    return kSign[below] * (kHalfTurn[behind] + kSign[behind] * ahead);
}

double acos(double cosine)
{
    const double c = cosine < -1 ? -1 : cosine > 1 ? 1 : cosine;
    // From half the angle, so that no digits are lost where the cosine is near 1 or -1.
    return 2 * atan2(std::sqrt(1 - c), std::sqrt(1 + c));
}

float pow(float x, float y)
{
    return std::pow(x, y);
}

} // namespace renderer
