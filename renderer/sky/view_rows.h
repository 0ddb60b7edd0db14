// ViewRows: how tables over directions from one eye are cut: rows of one angle to the vertical, crowded on both sides of
// the horizon, where air is thickest. Over an eye beyond the air they end where its edge is seen.
//
// Rows 0 to n - 1 go up from the horizon, n to 2 n - 1 down from it.
#pragma once

#include "renderer/sky/air.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace renderer {

class ViewRows {
public:
    ViewRows(const Air& air, double altitude, std::size_t rows_a_side)
        : rows_(rows_a_side),
          horizon_(-std::sqrt(altitude * (2 * air.radius_m + altitude)) / (air.radius_m + altitude))
    {
        const double above = altitude - air.height_m;
        if (above > 0)
            upper_ =
                -std::sqrt(above * (2 * air.radius_m + altitude + air.height_m)) / (air.radius_m + altitude);
    }

    [[nodiscard]] std::size_t count() const { return 2 * rows_; }
    [[nodiscard]] double horizon() const { return horizon_; } // its cosine to the vertical
    [[nodiscard]] double upper() const { return upper_; }     // beyond it there is no air to be seen

    // Squares of equal steps from the horizon: the first row above looks along it, the first below just under it.
    [[nodiscard]] double mu(std::size_t row) const
    {
        const bool sky = row < rows_;
        const double t = static_cast<double>(sky ? row : row - rows_) / static_cast<double>(rows_ - 1);
        const double mu = horizon_ + (sky ? upper_ - horizon_ : -1 - horizon_) * t * t;
        return sky ? std::max(mu, horizon_ + 1e-12) : std::min(mu, horizon_ - 1e-9);
    }

    struct Place {
        std::size_t row = 0; // and the next one
        float share = 0;     // of that
    };
    // False where there is nothing to be seen.
    [[nodiscard]] bool find(double mu, Place& place) const
    {
        if (mu > upper_) return false;
        const bool sky = mu >= horizon_;
        const double range = sky ? upper_ - horizon_ : 1 + horizon_;
        const double t = std::sqrt(std::clamp(std::abs(mu - horizon_) / std::max(1e-300, range), 0.0, 1.0));
        const double at = t * static_cast<double>(rows_ - 1);
        const auto below = std::min(static_cast<std::size_t>(at), rows_ - 2);
        place = {(sky ? 0 : rows_) + below, static_cast<float>(at - static_cast<double>(below))};
        return true;
    }

private:
    std::size_t rows_;
    double horizon_, upper_ = 1;
};

// Columns of such a table at equal steps of an angle from 0 to 180 degrees: azimuths from the sun.
struct AnglePlace {
    std::size_t column = 0;
    float share = 0;
};
inline AnglePlace angle_place(float angle_rad, std::size_t columns)
{
    const float at = angle_rad * (static_cast<float>(columns - 1) / 3.14159265f);
    const auto below = std::min(static_cast<std::size_t>(at), columns - 2);
    return {below, at - static_cast<float>(below)};
}

} // namespace renderer
