#include "tests/support/chi_square.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tests {

namespace {

using renderer::Vec3f;

// Rings are narrow around +z, where lobes are: theta grows as the square of the ring's number.
double ring_edge(std::size_t ring, std::size_t rings)
{
    const double x = static_cast<double>(ring) / static_cast<double>(rings);
    return std::numbers::pi * x * x;
}

std::size_t ring_of(double theta, std::size_t rings)
{
    const double x = std::sqrt(theta / std::numbers::pi) * static_cast<double>(rings);
    return std::min(rings - 1, static_cast<std::size_t>(x));
}

Vec3f direction(double theta, double phi)
{
    return renderer::to_float(
        {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
}

// Midpoint rule within one bin.
double integrate_bin(
    const std::function<double(Vec3f)>& density, double theta0, double theta1, double phi0, double phi1)
{
    constexpr int kSteps = 24;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double theta = theta0 + (theta1 - theta0) * (i + 0.5) / kSteps;
        for (int j = 0; j < kSteps; ++j)
            sum += density(direction(theta, phi0 + (phi1 - phi0) * (j + 0.5) / kSteps)) * std::sin(theta);
    }
    return sum * (theta1 - theta0) * (phi1 - phi0) / (kSteps * kSteps);
}

} // namespace

// Regularised upper incomplete gamma function Q(k/2, x/2): series below, continued fraction above.
// Source: W. Press et al., "Numerical Recipes", section 6.2.
double chi_square_p_value(double statistic, double degrees)
{
    const double a = degrees / 2, x = statistic / 2;
    if (x <= 0) return 1;
    const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > sum * 1e-15; ++n)
            sum += term *= x / (a + n);
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return front * h;
}

ChiSquareResult chi_square(std::size_t n,
                           const std::function<Vec3f(std::size_t)>& draw,
                           const std::function<double(Vec3f)>& density,
                           std::size_t rings,
                           std::size_t sectors)
{
    std::vector<double> seen(rings * sectors), expected(rings * sectors);
    ChiSquareResult result;
    const double turn = 2 * std::numbers::pi;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3f w = draw(i);
        if (w == Vec3f{}) continue;
        const double theta = std::acos(std::clamp(static_cast<double>(w.z), -1.0, 1.0));
        double phi = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x));
        if (phi < 0) phi += turn;
        const auto sector =
            std::min(sectors - 1, static_cast<std::size_t>(phi / turn * static_cast<double>(sectors)));
        ++seen[ring_of(theta, rings) * sectors + sector];
        result.drawn_share += 1 / static_cast<double>(n);
    }
    for (std::size_t r = 0; r < rings; ++r)
        for (std::size_t s = 0; s < sectors; ++s) {
            const double share =
                integrate_bin(density,
                              ring_edge(r, rings),
                              ring_edge(r + 1, rings),
                              turn * static_cast<double>(s) / static_cast<double>(sectors),
                              turn * static_cast<double>(s + 1) / static_cast<double>(sectors));
            result.expected_share += share;
            expected[r * sectors + s] = share * static_cast<double>(n);
        }
    double merged_seen = 0, merged_expected = 0, bins = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        merged_seen += seen[i];
        merged_expected += expected[i];
        if (merged_expected < 5 && i + 1 != seen.size()) continue;
        if (merged_expected > 0)
            result.statistic +=
                (merged_seen - merged_expected) * (merged_seen - merged_expected) / merged_expected;
        else if (merged_seen > 0)
            result.statistic = HUGE_VAL;
        bins += merged_expected > 0 ? 1 : 0;
        merged_seen = merged_expected = 0;
    }
    result.degrees = bins - 1;
    result.p_value = chi_square_p_value(result.statistic, result.degrees);
    return result;
}

} // namespace tests
