#include "renderer/sky/sky_irradiance.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/optical_depth.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {
constexpr std::size_t kZeniths = 24, kAzimuths = 17; // azimuths of half a circle
}

SkyIrradiance sky_irradiance(
    const Air& air, const ScatteredLight* scattered, double altitude, double mu_sun, SkyPrecision precision)
{
    SkyIrradiance sum;
    const WayOut to_sun = columns_to_top(air, altitude, mu_sun);
    for (std::size_t w = 0; w < air.wavelengths && !to_sun.blocked; ++w)
        sum.sun[w] = std::max(0.0, mu_sun) * air.transmittance(w, to_sun.columns);
    const double sun_sine = std::sqrt(std::max(0.0, (1 - mu_sun) * (1 + mu_sun)));
    const GaussLegendre rule(kZeniths);
    for (std::size_t j = 0; j < kZeniths; ++j) {
        const double t = rule.x[j], mu = t * t; // close together at the horizon
        const PlanetRay ray(air.radius_m, altitude, mu);
        LightPath path;
        if (scattered) path = scattered->path(ray);
        for (std::size_t p = 0; p < kAzimuths; ++p) {
            const bool end = p == 0 || p + 1 == kAzimuths;
            const double cosine = sin_cos_deg(180 * static_cast<double>(p) / (kAzimuths - 1)).second;
            const double nu = std::clamp(mu * mu_sun + std::sqrt(1 - mu * mu) * sun_sine * cosine, -1.0, 1.0);
            const double weight = rule.weight[j] * 2 * t * mu * (end ? 1 : 2) * kPi / (kAzimuths - 1);
            const SingleScattering once = single_scattering(air, ray, {altitude, mu, mu_sun, nu}, precision);
            Spectrum more{};
            if (scattered) more = scattered->radiance(path, mu_sun, nu);
            for (std::size_t w = 0; w < air.wavelengths; ++w) {
                sum.single[w] += weight * once.air[w];
                sum.multiple[w] += weight * more[w];
            }
        }
    }
    return sum;
}

} // namespace renderer
