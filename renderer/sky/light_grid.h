// LightGrid: where scattered light is kept: altitudes, zenith angles of the sun, directions.
//
// Suns stand close together around the planet's edge, where light fades by half a degree; altitudes near the ground.
#pragma once

#include "renderer/sky/air.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace renderer {

struct GridResolution {
    std::size_t altitudes = 24;
    double sun_step_deg = 0.5;       // around the edge; elsewhere 4 and 12 times as wide
    std::size_t sky = 16, down = 10; // directions above and below the horizon, of which light comes
    std::size_t azimuths = 17;       // of those, from 0 to 180 degrees
    std::size_t out_angles =
        37; // into which light goes: zenith angles and azimuths of the source, 0 to 180 degrees
    std::size_t points = 16; // a side of the closest approach along a line of sight
};

// A place between two neighbours.
struct Between {
    std::size_t below = 0;
    float share = 0; // of the one above
};

class LightGrid {
public:
    LightGrid(const Air& air, const GridResolution& resolution);

    const GridResolution& resolution() const { return resolution_; }
    std::size_t altitudes() const { return resolution_.altitudes; }
    std::size_t suns() const { return suns_; }
    double altitude(std::size_t i) const
    {
        const double share = static_cast<double>(i) / static_cast<double>(resolution_.altitudes - 1);
        return height_ * share * share;
    }
    double sun_zenith_deg(std::size_t k) const;

    Between altitude_at(float altitude) const
    {
        return between(std::sqrt(std::max(0.0f, altitude) * inverse_height_) *
                           static_cast<float>(resolution_.altitudes - 1),
                       resolution_.altitudes);
    }
    // False where the sun is so low that no light is kept.
    bool sun_at(float zenith_rad, Between& found) const
    {
        float at = 0;
        if (zenith_rad < regions_[1].from)
            at = regions_[0].first + zenith_rad * regions_[0].density;
        else if (zenith_rad < regions_[2].from)
            at = regions_[1].first + (zenith_rad - regions_[1].from) * regions_[1].density;
        else if (zenith_rad < regions_[3].from)
            at = regions_[2].first + (zenith_rad - regions_[2].from) * regions_[2].density;
        else
            at = regions_[3].first + (zenith_rad - regions_[3].from) * regions_[3].density;
        if (!(at < static_cast<float>(suns_ - 1))) return false;
        found = between(at, suns_);
        return true;
    }
    Between out_angle_at(float angle_rad) const
    {
        return between(angle_rad * out_density_, resolution_.out_angles);
    }

private:
    static Between between(float at, std::size_t count)
    {
        const auto below = std::min(static_cast<std::size_t>(at), count - 2);
        return {below, at - static_cast<float>(below)};
    }
    // Suns from an angle on, so many a radian.
    struct Region {
        float from = 0, first = 0, density = 0;
    };

    GridResolution resolution_;
    double height_;
    float inverse_height_, out_density_;
    Region regions_[4];
    std::size_t suns_ = 0;
};

} // namespace renderer
