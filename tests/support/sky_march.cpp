#include "tests/support/sky_march.h"

#include "renderer/sky/phase.h"

#include <cmath>

namespace tests {

namespace {

double to_sphere(double r, double mu, double sphere)
{
    return -r * mu + std::sqrt(r * r * (mu * mu - 1) + sphere * sphere);
}

} // namespace

renderer::Spectrum march(const renderer::Air& air,
                         const renderer::SkyGeometry& geometry,
                         MarchSteps kind,
                         int view_steps,
                         int sun_steps)
{
    using renderer::Columns;
    const double r0 = air.radius_m + geometry.altitude_m, top = air.radius_m + air.height_m;
    const double perigee2 = r0 * r0 * (1 - geometry.mu * geometry.mu);
    const bool ground = geometry.mu < 0 && perigee2 < air.radius_m * air.radius_m;
    const double length = ground ? -r0 * geometry.mu - std::sqrt(air.radius_m * air.radius_m - perigee2)
                                 : to_sphere(r0, geometry.mu, top);
    const double step = length / view_steps, share = kind == MarchSteps::half ? 0.5 : 1.0;
    const double phase_r = renderer::rayleigh_phase(geometry.nu);
    const double phase_m = renderer::mie_phase(air.phase, air.g, geometry.nu);
    renderer::Spectrum light{};
    Columns way;
    for (int i = 0; i < view_steps; ++i) {
        const double s = (i + 0.5) * step;
        const double r = std::sqrt(r0 * r0 + 2 * r0 * geometry.mu * s + s * s);
        const double mu_sun = (r0 * geometry.mu_sun + s * geometry.nu) / r;
        const Columns here = air.density(r - air.radius_m) * step;
        const Columns to_here = way + here * share;
        way = way + here;
        const double sun_step = to_sphere(r, mu_sun, top) / sun_steps;
        Columns sun;
        bool dark = false;
        for (int k = 0; k < sun_steps && !dark; ++k) {
            const double t = (k + 0.5) * sun_step;
            const double altitude = std::sqrt(r * r + 2 * r * mu_sun * t + t * t) - air.radius_m;
            dark = altitude < 0;
            sun = sun + air.density(altitude) * sun_step;
        }
        if (dark) continue;
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            light[w] +=
                (air.rayleigh[w] * here.rayleigh * phase_r + air.mie_scattering[w] * here.mie * phase_m) *
                air.transmittance(w, to_here + sun);
    }
    return light;
}

} // namespace tests
