#include "renderer/sampling/warp.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace renderer {

DiskPoint concentric_disk(Sample2 u)
{
    const double a = 2 * static_cast<double>(u.u0) - 1, b = 2 * static_cast<double>(u.u1) - 1;
    if (a == 0 && b == 0) return {0, 0};
    // Which of the two is the larger is as good as random: no branch on it.
    const double place[2] = {a, b};
    const std::size_t larger = std::abs(a) > std::abs(b) ? 0 : 1;
    const double radius = place[larger];
    const auto [s, c] = sin_cos_near_zero(kPi / 4 * (place[1 - larger] / radius));
    double point[2];
    point[larger] = radius * c;
    point[1 - larger] = radius * s;
    return {point[0], point[1]};
}

Vec3f sample_cosine_hemisphere(Sample2 u)
{
    const DiskPoint d = concentric_disk(u);
    const double z = std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y));
    return to_float({d.x, d.y, z});
}

float pdf_cosine_hemisphere(float cos_theta)
{
    return cos_theta > 0 ? cos_theta * static_cast<float>(1 / kPi) : 0.0f;
}

Vec3f sample_power_lobe(Sample2 u, double exponent)
{
    // 1 - u0 is in (0, 1]: the logarithm is finite.
    const double log_u = log2(1 - static_cast<double>(u.u0));
    const double cos_theta = exp2(std::max(log_u / (exponent + 1), -1000.0));
    const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
    const auto [s, c] = sin_cos(2 * kPi * static_cast<double>(u.u1));
    return to_float({sin_theta * c, sin_theta * s, cos_theta});
}

double power_of_cosine(double one_minus_cos, double exponent)
{
    if (exponent == 0) return 1;
    const double cosine = 1 - one_minus_cos;
    if (!(cosine > 0)) return 0;
    // log(1 - x) loses digits for small x: its series takes over, where x^4/5 is below rounding.
    constexpr double kSeriesBelow = 1e-4, kOneOverLn2 = 1.4426950408889634074;
    const double x = one_minus_cos;
    const double log_cos = x < kSeriesBelow
                               ? -x * (1 + x * (0.5 + x * (1.0 / 3 + x * (0.25 + x * 0.2)))) * kOneOverLn2
                               : log2(cosine);
    const double power = exponent * log_cos;
    return power > -1000 ? exp2(power) : 0;
}

double pdf_power_lobe(double one_minus_cos, double exponent)
{
    if (!(one_minus_cos < 1)) return 0;
    return (exponent + 1) / (2 * kPi) * power_of_cosine(std::max(0.0, one_minus_cos), exponent);
}

Frame::Frame(Vec3f normal) : z(normal)
{
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    x = {1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    y = {b, sign + normal.y * normal.y * a, -normal.y};
}

std::pair<Vec3d, Vec3d> basis_around(Vec3d z)
{
    const double sign = std::copysign(1.0, z.z), a = -1 / (sign + z.z), b = z.x * z.y * a;
    return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}};
}

} // namespace renderer
