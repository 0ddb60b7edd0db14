#include "renderer/math/transcendental.h"
#include "renderer/sky/air.h"
#include "renderer/sky/sky_irradiance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace renderer;

namespace {

// By even steps much finer than the haze's peak.
double dense(const Air& air, double altitude, double mu_sun)
{
    constexpr int kSteps = 120, kAround = 60;
    double sum = 0;
    for (int j = 0; j < kSteps; ++j) {
        const auto [mu, sine] = sin_cos_deg(90 * (j + 0.5) / kSteps);
        const PlanetRay ray(air.radius_m, altitude, mu);
        for (int p = 0; p < kAround; ++p) {
            const double cosine = sin_cos_deg(180 * (p + 0.5) / kAround).second;
            const double nu =
                std::clamp(mu * mu_sun + sine * std::sqrt(1 - mu_sun * mu_sun) * cosine, -1.0, 1.0);
            sum += single_scattering(air, ray, {altitude, mu, mu_sun, nu}, SkyPrecision::quick).air[0] * mu *
                   sine;
        }
    }
    return sum * (kPi / 2 / kSteps) * (2 * kPi / kAround);
}

} // namespace

TEST(SkyIrradiance, FindsThePeakOfHazeAboutTheSun)
{
    AtmosphereDescription description = atmosphere_preset(AtmospherePreset::reference_s);
    description.mie.g = 0.95;
    const Air air = make_air(description);
    for (const double sun_deg : {0.0, 75.0}) {
        const double mu_sun = sin_cos_deg(90 - sun_deg).first;
        const double found = sky_irradiance(air, nullptr, 2, mu_sun, SkyPrecision::quick).single[0];
        EXPECT_NEAR(found / dense(air, 2, mu_sun), 1, 4e-3) << sun_deg;
    }
}
