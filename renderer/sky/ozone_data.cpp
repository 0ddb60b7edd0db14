// Ozone cross-sections at 233 K (Serdyuchenko et al., University of Bremen), as averaged to 10 nm in the demo of Bruneton 2017.
#include "renderer/sky/ozone_data.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace renderer {

namespace {

// 1e-27 m^2, from 360 nm in steps of 10 nm.
constexpr std::array kCrossSection{
    1.1800,   0.2182,   0.2818,   0.6636,   1.5270,   2.7630,   5.5200,   8.4510,   15.8200,  23.1600,
    36.6900,  49.2400,  77.5200,  90.1600,  148.0000, 160.2000, 213.9000, 275.5000, 309.1000, 350.0000,
    426.6000, 467.2000, 439.8000, 470.1000, 501.9000, 430.5000, 374.0000, 321.5000, 266.2000, 223.8000,
    185.2000, 147.3000, 120.9000, 94.2300,  74.5500,  65.6600,  51.0500,  41.5000,  42.2800,  32.3700,
    24.5100,  28.0100,  25.3400,  16.2400,  14.6500,  20.7800,  13.8300,  7.1050,
};
// 300 DU, 2.687e20 molecules/m^2 each, over the 15 km that the tent holds.
constexpr double kPeakDensity = 300 * 2.687e20 / 15'000;

} // namespace

double ozone_absorption(double wavelength_nm)
{
    const double at =
        std::clamp((wavelength_nm - 360) / 10, 0.0, static_cast<double>(kCrossSection.size() - 1));
    const auto below = std::min(static_cast<std::size_t>(at), kCrossSection.size() - 2);
    const double share = at - static_cast<double>(below);
    return 1e-27 * kPeakDensity *
           (kCrossSection[below] + (kCrossSection[below + 1] - kCrossSection[below]) * share);
}

} // namespace renderer
