#include "renderer/materials/fresnel.h"

#include "renderer/math/transcendental.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace renderer {

DielectricBoundary meet_dielectric(double cos_incident, double eta)
{
    const double c = std::clamp(cos_incident, 0.0, 1.0);
    if (eta == 1) return {0, c};
    // cos_t^2 = 1 - sin^2 / eta^2, written so that it does not cancel where all but nothing is refracted.
    const double cos2_t = ((eta - 1) * (eta + 1) + c * c) / (eta * eta);
    if (!(cos2_t > 0)) return {};
    const double t = std::sqrt(cos2_t);
    const double parallel = (eta * c - t) / (eta * c + t);
    const double perpendicular = (c - eta * t) / (c + eta * t);
    return {0.5 * (parallel * parallel + perpendicular * perpendicular), std::min(t, 1.0)};
}

double fresnel_dielectric(double cos_incident, double eta)
{
    return meet_dielectric(cos_incident, eta).reflected;
}

double fresnel_conductor(double cos_incident, double eta, double k)
{
    const double c = std::clamp(cos_incident, 0.0, 1.0);
    const double c2 = c * c, s2 = (1 - c) * (1 + c);
    // (a + i b)^2 = (eta + i k)^2 - s^2
    const double real = eta * eta - k * k - s2, imaginary = 2 * eta * k;
    const double a2_b2 = std::sqrt(real * real + imaginary * imaginary);
    const double a = std::sqrt(std::max(0.0, 0.5 * (a2_b2 + real)));
    const double twice = 2 * a * c;
    const double both = a2_b2 + c2;
    const double perpendicular = both + twice > 0 ? (both - twice) / (both + twice) : 1;
    const double sum = c2 * a2_b2 + s2 * s2, turn = twice * s2;
    // At grazing incidence both vanish together: the quotient is 1.
    const double ratio = sum + turn > 0 ? (sum - turn) / (sum + turn) : 1;
    return 0.5 * perpendicular * (1 + ratio);
}

Rgb fresnel_conductor(double cos_incident, Rgb eta, Rgb k)
{
    const auto one = [&](float n, float absorbed) {
        return static_cast<float>(
            fresnel_conductor(cos_incident, static_cast<double>(n), static_cast<double>(absorbed)));
    };
    return {one(eta.r, k.r), one(eta.g, k.g), one(eta.b, k.b)};
}

double normal_reflectance(double eta)
{
    const double root = (eta - 1) / (eta + 1);
    return root * root;
}

double schlick_weight(double cos_incident)
{
    const double x = std::clamp(1 - cos_incident, 0.0, 1.0), x2 = x * x;
    return x2 * x2 * x;
}

double average_fresnel_dielectric(double eta)
{
    // From within, by reciprocity: what gets out is what gets in, over the solid angle that it is spread
    // to.
    if (eta < 1) return 1 - (1 - average_fresnel_dielectric(1 / eta)) * eta * eta;
    // The closed form subtracts poles at eta = 1; there a straight line is right to 3e-6.
    if (eta < 1.002) return (eta - 1) * (average_fresnel_dielectric(1.002) / 0.002);
    constexpr double kLn2 = 0.69314718055994530942;
    const double n = eta, n2 = n * n, n4 = n2 * n2;
    const double a = n2 + 1, b = n4 - 1;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / (a * a * a) * (log2((n - 1) / (n + 1)) * kLn2) -
           2 * n * n2 * (n2 + 2 * n - 1) / (a * b) + 8 * n4 * (n4 + 1) / (a * b * b) * (log2(n) * kLn2);
}

double average_fresnel_conductor(double eta, double k)
{
    // Gauss's rule of 8 points on [0, 1]: right to 1e-5 for metals, whose F is smooth in the cosine.
    constexpr std::array kAt{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    constexpr std::array kWeight{
        0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    double sum = 0;
    for (std::size_t i = 0; i < kAt.size(); ++i)
        for (const double at : {0.5 - 0.5 * kAt[i], 0.5 + 0.5 * kAt[i]})
            sum += kWeight[i] * at * fresnel_conductor(at, eta, k);
    return sum;
}

} // namespace renderer
