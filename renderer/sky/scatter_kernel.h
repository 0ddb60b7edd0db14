// ScatterKernel: from the light that comes to a place, out of every direction, to the light that leaves it there.
//
// Rayleigh's phase function is a polynomial of second degree, so four moments of the light hold what it makes of any
// light. For the other, light and phase function become Fourier series over azimuth, which makes a product of each order
// alone out of the integral; its result is kept over zenith angle and azimuth.
//
// Frame   z to the vertical, the sun's azimuth is 0; light is the same left and right of it.
// Source  the azimuthal expansion of Chandrasekhar 1950, section 48.
#pragma once

#include "renderer/sky/air.h"
#include "renderer/sky/lanes.h"
#include "renderer/sky/light_grid.h"

#include <cstddef>
#include <vector>

namespace renderer {

// Directions from which light comes at one altitude: mu ascending from the horizon on, above and then below it.
struct Directions {
    std::vector<double> mu, sine, weight;               // weight: d mu
    std::vector<double> azimuth_cosine, azimuth_weight; // from 0 to pi; weights sum to 2 pi
};
Directions directions_at(const Air& air, const GridResolution& resolution, double altitude);

// What leaves a place by Rayleigh scattering, 3 / (16 pi) times: xx (1 + x^2) + yy (1 + y^2) + zz (1 + z^2) + 2 xz x z.
struct Moments {
    Lanes xx{}, yy{}, zz{}, xz{};
};

class ScatterKernel {
public:
    ScatterKernel(const Air& air, const GridResolution& resolution, const Directions& directions);

    // light[mu][azimuth]; adds nothing, sets.
    [[nodiscard]] Moments moments(const Lanes* light) const;
    // out[zenith angle][azimuth]
    void scatter(const Lanes* light, Lanes* out, std::vector<Lanes>& scratch) const;

private:
    std::size_t angles_, azimuths_, out_;
    const Directions& directions_;
    std::vector<float> kernel_;     // [order][out zenith][mu], times the weight of mu
    std::vector<float> to_order_;   // [order][azimuth], times its weight
    std::vector<float> from_order_; // [out azimuth][order]
};

} // namespace renderer
