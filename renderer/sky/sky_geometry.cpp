#include "renderer/math/transcendental.h"
#include "renderer/sky/single_scattering.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

SkyGeometry of(double altitude_m, double sine, double cosine, double sun_zenith, double azimuth)
{
    const auto [sun_sine, sun_cosine] = sin_cos_deg(sun_zenith);
    const double nu = sun_cosine * cosine + sun_sine * sine * sin_cos_deg(azimuth).second;
    return {altitude_m, cosine, sun_cosine, std::clamp(nu, -1.0, 1.0)};
}

} // namespace

SkyGeometry
SkyGeometry::from_angles_deg(double altitude_m, double sun_zenith, double view_zenith, double azimuth)
{
    const auto [sine, cosine] = sin_cos_deg(view_zenith);
    return of(altitude_m, sine, cosine, sun_zenith, azimuth);
}

SkyGeometry SkyGeometry::towards_tangent_deg(
    double planet_radius, double altitude_m, double tangent, double sun_zenith, double azimuth)
{
    if (tangent < 0) return of(altitude_m, 0, -1, sun_zenith, azimuth);
    const double sine = std::min(1.0, (planet_radius + tangent) / (planet_radius + altitude_m));
    return of(altitude_m, sine, -std::sqrt((1 - sine) * (1 + sine)), sun_zenith, azimuth);
}

} // namespace renderer
