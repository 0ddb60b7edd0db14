#include "renderer/sky/sky_irradiance.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/optical_depth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kElevations = 16, kAzimuths = 20; // elevations on either side of the sun

struct Node {
    double degrees = 0, weight = 0; // in radians
};

// About the sun light is as peaked as the haze's phase: places crowd there as cubes do, and at the horizon as squares.
std::vector<Node> elevations_about(double sun_deg)
{
    const GaussLegendre rule(kElevations);
    std::vector<Node> nodes;
    const double above = 90 - std::max(0.0, sun_deg);
    for (std::size_t i = 0; i < kElevations; ++i) {
        const double s = rule.x[i], weight = rule.weight[i] * 3 * s * s * (kPi / 180), left = 1 - s * s * s;
        nodes.push_back({std::max(0.0, sun_deg) + above * s * s * s, above * weight});
        if (sun_deg > 0) nodes.push_back({sun_deg * left * left, sun_deg * 2 * left * weight});
    }
    return nodes;
}

// Of half a circle.
std::vector<Node> azimuths_about_the_sun()
{
    const GaussLegendre rule(kAzimuths);
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < kAzimuths; ++i) {
        const double s = rule.x[i];
        nodes.push_back({180 * s * s * s, rule.weight[i] * 3 * s * s * kPi});
    }
    return nodes;
}

} // namespace

SkyIrradiance sky_irradiance(
    const Air& air, const ScatteredLight* scattered, double altitude, double mu_sun, SkyPrecision precision)
{
    SkyIrradiance sum;
    const WayOut to_sun = columns_to_top(air, altitude, mu_sun);
    for (std::size_t w = 0; w < air.wavelengths && !to_sun.blocked; ++w)
        sum.sun[w] = std::max(0.0, mu_sun) * air.transmittance(w, to_sun.columns);
    const double sun_sine = std::sqrt(std::max(0.0, (1 - mu_sun) * (1 + mu_sun)));
    const std::vector<Node> azimuths = azimuths_about_the_sun();
    for (const Node& elevation : elevations_about(90 - acos(mu_sun) * (180 / kPi))) {
        const auto [mu, sine] = sin_cos_deg(elevation.degrees);
        const PlanetRay ray(air.radius_m, altitude, mu);
        LightPath path;
        if (scattered) path = scattered->path(ray);
        for (const Node& azimuth : azimuths) {
            const double cosine = sin_cos_deg(azimuth.degrees).second;
            const double nu = std::clamp(mu * mu_sun + sine * sun_sine * cosine, -1.0, 1.0);
            const double weight = elevation.weight * mu * sine * 2 * azimuth.weight;
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
