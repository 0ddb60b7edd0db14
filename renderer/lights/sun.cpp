#include "renderer/lights/sun.h"

#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace renderer {

Sun prepare_sun(const SunLight& light)
{
    Sun sun;
    sun.toward = -normalize(light.direction);
    std::tie(sun.across, sun.upward) = basis_around(sun.toward);
    const double half_sine = sin_cos_deg(light.angular_radius_deg / 2).first;
    sun.one_minus_cosine = 2 * half_sine * half_sine;
    const double within =
        std::min(sun.one_minus_cosine, 1.0);           // beyond half the sky nothing reaches a facing surface
    const double facing = kPi * within * (2 - within); // pi sin^2
    sun.radiance = {static_cast<float>(static_cast<double>(light.irradiance.r) / facing),
                    static_cast<float>(static_cast<double>(light.irradiance.g) / facing),
                    static_cast<float>(static_cast<double>(light.irradiance.b) / facing)};
    sun.pdf = 1 / (2 * kPi * sun.one_minus_cosine);
    return sun;
}

Vec3d sample(const Sun& sun, Sample2 u)
{
    const double off = static_cast<double>(u.u0) * sun.one_minus_cosine;
    const double sine = std::sqrt(std::max(0.0, off * (2 - off)));
    const auto [s, c] = sin_cos(2 * kPi * static_cast<double>(u.u1));
    return normalize(sun.toward * (1 - off) + (sun.across * c + sun.upward * s) * sine);
}

} // namespace renderer
