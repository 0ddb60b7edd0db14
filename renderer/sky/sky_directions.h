// SkyDirections: directions from one eye, as far apart as so many can be, over all that has air or ground before it.
#pragma once

#include "renderer/math/transcendental.h"
#include "renderer/sky/single_scattering.h"
#include "renderer/sky/view_rows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace renderer {

class SkyDirections {
public:
    SkyDirections(const Air& air, double altitude, double mu_sun, std::size_t count)
        : upper_(ViewRows(air, altitude, 2).upper()), altitude_(altitude), mu_sun_(mu_sun), count_(count)
    {
    }

    struct Direction {
        SkyGeometry geometry;
        double azimuth_cosine = 1; // to the sun
    };
    // On a spiral, each a golden section of a turn from the last.
    Direction operator[](std::size_t i) const
    {
        constexpr double kGoldenTurn = 0.6180339887498949;
        const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count_);
        const double mu = -1 + (upper_ + 1) * share, turn = static_cast<double>(i) * kGoldenTurn;
        const double cosine = sin_cos_deg(360 * (turn - std::floor(turn))).second;
        const double sines = std::sqrt(std::max(0.0, (1 - mu * mu) * (1 - mu_sun_ * mu_sun_)));
        return {{altitude_, mu, mu_sun_, std::clamp(mu * mu_sun_ + sines * cosine, -1.0, 1.0)}, cosine};
    }

private:
    double upper_, altitude_, mu_sun_;
    std::size_t count_;
};

} // namespace renderer
