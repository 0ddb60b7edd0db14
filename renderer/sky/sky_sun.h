// SunThroughAir: what of the sun's light reaches a place, by look-up.
#pragma once

#include "renderer/sky/column_table.h"
#include "renderer/sky/lanes.h"
#include "renderer/sky/planet_ray.h"

#include <algorithm>

namespace renderer {

class SunThroughAir {
public:
    SunThroughAir(const Air& air, const ColumnTable& columns, double altitude, double mu_sun)
        : hidden_(mu_sun < 0 && PlanetRay(air.radius_m, altitude, mu_sun).perigee() < 0)
    {
        if (!hidden_) columns_ = columns.at(altitude, mu_sun);
    }

    [[nodiscard]] bool hidden() const { return hidden_; } // behind the planet
    [[nodiscard]] Lanes transmittance(const Air& air, std::size_t group) const
    {
        Lanes result{};
        const std::size_t first = group * kLanes, count = std::min(kLanes, air.wavelengths - first);
        for (std::size_t lane = 0; lane < count && !hidden_; ++lane)
            result[lane] = static_cast<float>(air.transmittance(first + lane, columns_));
        return result;
    }

private:
    bool hidden_;
    Columns columns_;
};

} // namespace renderer
