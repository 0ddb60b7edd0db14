#include "renderer/sky/tent_column.h"

#include "renderer/math/transcendental.h"

#include <algorithm>

namespace renderer {

namespace {

// The integral of the altitude over [low, high], 0 <= low <= high.
double altitudes(double planet_radius, const PlanetRay& ray, double low, double high)
{
    const double at_low = ray.radius_at(low), at_high = ray.radius_at(high),
                 impact = planet_radius + ray.perigee();
    double twice = high * at_high - low * at_low;
    if (impact > 0) twice += impact * impact * log((high + at_high) / (low + at_low));
    return twice / 2 - planet_radius * (high - low);
}

// The one u >= 0 that is so high, cut to [low, high]: far below the ground the ray's own answer does not hold.
double cut(const PlanetRay& ray, double altitude, double low, double high)
{
    return altitude > ray.perigee() ? std::clamp(ray.distance_at(altitude), low, high) : low;
}

double one_side(
    double center, double half_width, double planet_radius, const PlanetRay& ray, double low, double high)
{
    const double foot = cut(ray, center - half_width, low, high), peak = cut(ray, center, low, high),
                 end = cut(ray, center + half_width, low, high);
    double sum = 0;
    if (peak > foot) sum += altitudes(planet_radius, ray, foot, peak) - (center - half_width) * (peak - foot);
    if (end > peak) sum += (center + half_width) * (end - peak) - altitudes(planet_radius, ray, peak, end);
    return sum / half_width;
}

} // namespace

double tent_column(double center_m,
                   double half_width_m,
                   double planet_radius,
                   const PlanetRay& ray,
                   double begin,
                   double end)
{
    const auto side = [&](double low, double high) {
        return one_side(center_m, half_width_m, planet_radius, ray, low, high);
    };
    if (!(end > begin)) return 0; // by rounding, close below the top
    if (begin >= 0) return side(begin, end);
    if (end <= 0) return side(-end, -begin);
    return side(0, -begin) + side(0, end);
}

} // namespace renderer
