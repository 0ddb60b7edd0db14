// Light that the air scatters once on its way from the sun to the eye, and that of the ground which the sun lights.
//
// Frame   the eye lies on the planet's vertical at `altitude`; mu, mu_sun are cosines of view and sun to it, nu the
//         cosine between view and sun. The sun is a direction.
// Units   L / E0, 1/sr: radiance over the sun's irradiance above the air.
// Source  Nishita et al. 1993; Bruneton, Neyret 2008, eq. 6: quadrature on pieces cut at the closest approach, the edges
//         of the planet's shadow and the cuts of the air, each halved until it agrees with its halves (exact) or is smooth
//         by the decay of its own Legendre series (quick).
// Errors  some 1e-7 of the radiance (exact), 1e-3 (quick).
// Cost    exact 0.2 to 2 ms; quick a fifteenth.
// Threads any number at once.
#pragma once

#include "renderer/sky/air.h"
#include "renderer/sky/planet_ray.h"

#include <cstddef>
#include <cstdint>

namespace renderer {

struct SkyGeometry {
    double altitude_m = 0; // >= 0
    double mu = 1, mu_sun = 1, nu = 1;

    // azimuth: between the vertical planes of view and sun.
    static SkyGeometry
    from_angles_deg(double altitude_m, double sun_zenith, double view_zenith, double azimuth);
    // Downwards past the ground at the altitude `tangent`; below 0: straight down.
    static SkyGeometry towards_tangent_deg(
        double planet_radius, double altitude_m, double tangent, double sun_zenith, double azimuth);
};

enum class SkyPrecision : std::uint8_t { exact, quick };

struct SingleScattering {
    Spectrum air{};    // scattered by the air
    Spectrum ground{}; // by the ground, seen through the air
    bool hits_ground = false;
};

SingleScattering single_scattering(const Air& air, const SkyGeometry& geometry, SkyPrecision precision);
// Along a ray that is known better than by its angle.
SingleScattering
single_scattering(const Air& air, const PlanetRay& ray, const SkyGeometry& geometry, SkyPrecision precision);

} // namespace renderer
