#include "renderer/sky/optical_depth.h"

#include "renderer/sky/gauss_legendre.h"

#include <algorithm>

namespace renderer {

namespace {

constexpr std::size_t kPoints = 16;

Columns piece(const Air& air, const PlanetRay& ray, double begin, double end)
{
    static const GaussLegendre rule(kPoints);
    Columns sum;
    const double length = end - begin;
    for (std::size_t i = 0; i < kPoints; ++i)
        sum = sum + air.density(ray.altitude(begin + length * rule.x[i])) * rule.weight[i];
    return sum * length;
}

// One side of the closest approach, 0 <= low <= high.
Columns one_side(const Air& air, const PlanetRay& ray, double low, double high)
{
    Columns sum;
    double at = low;
    const auto go_to = [&](double next) {
        // The altitude bends on the scale of the radius: longer pieces would not be smooth.
        while (next - at > 1.5 * ray.radius_at(at)) {
            const double stop = at + 1.5 * ray.radius_at(at);
            sum = sum + piece(air, ray, at, stop);
            at = stop;
        }
        sum = sum + piece(air, ray, at, next);
        at = next;
    };
    for (const double cut : air.cuts) {
        const double u = cut > ray.perigee() ? ray.distance_at(cut) : 0;
        if (u > at && u < high) go_to(u);
    }
    if (high > at) go_to(high);
    return sum;
}

} // namespace

Columns columns_along(const Air& air, const PlanetRay& ray, double begin, double end)
{
    if (!(end > begin)) return {};
    if (begin >= 0) return one_side(air, ray, begin, end);
    if (end <= 0) return one_side(air, ray, -end, -begin);
    return one_side(air, ray, 0, -begin) + one_side(air, ray, 0, end);
}

WayOut columns_to_top(const Air& air, double altitude, double mu)
{
    const PlanetRay ray(air.radius_m, altitude, mu);
    if (ray.hits_ground()) return {{}, true};
    const PlanetRay::Reach reach = ray.reach(air.height_m);
    return {columns_along(air, ray, reach.begin, reach.end), false};
}

Columns columns_past_ground(const Air& air, double altitude, double mu)
{
    const PlanetRay ray(air.radius_m, altitude, mu);
    const double out = ray.distance_at(air.height_m);
    return columns_along(air, ray, std::max(ray.start(), -out), out);
}

} // namespace renderer
