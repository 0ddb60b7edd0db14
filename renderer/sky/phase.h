// Phase functions: the share of scattered light that goes a way, 1/sr; each integrates to 1 over the sphere.
//
// `nu` is the cosine of the angle by which light is turned.
// Source  Rayleigh; Cornette, Shanks, "Physically reasonable analytic expression for the single-scattering phase
//         function", 1992; Henyey, Greenstein 1941.
#pragma once

#include "renderer/description/atmosphere.h"
#include "renderer/math/transcendental.h"

#include <cmath>

namespace renderer {

inline double rayleigh_phase(double nu)
{
    return 3 / (16 * kPi) * (1 + nu * nu);
}

inline double mie_phase(MiePhase phase, double g, double nu)
{
    // 1 + g^2 - 2 g nu, whose digits would be lost near the peak.
    const double toward = g >= 0 ? 1 - nu : 1 + nu, a = std::abs(g);
    const double base = (1 - a) * (1 - a) + 2 * a * toward;
    const double lobe = (1 - g * g) / (base * std::sqrt(base));
    switch (phase) {
    case MiePhase::cornette_shanks:
        return 3 / (8 * kPi) * lobe * (1 + nu * nu) / (2 + g * g);
    case MiePhase::henyey_greenstein:
        return 1 / (4 * kPi) * lobe;
    }
    return 0;
}

} // namespace renderer
