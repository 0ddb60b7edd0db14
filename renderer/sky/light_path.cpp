#include "renderer/sky/light_path.h"

#include "renderer/sky/arc_cosine.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/optical_depth.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

struct Sample {
    double u = 0, weight = 0;
};

// Points crowd at the low end of each part, where the air is.
std::vector<Sample> samples_along(const PlanetRay& ray, double top, std::size_t points)
{
    const PlanetRay::Reach reach = ray.reach(top);
    if (!(reach.end > reach.begin)) return {};
    const GaussLegendre rule(points);
    std::vector<Sample> samples;
    const auto part = [&](double low, double high) { // low may be beyond high: then backwards
        for (std::size_t i = 0; i < points; ++i) {
            const double t = rule.x[i];
            samples.push_back({low + (high - low) * t * t, rule.weight[i] * 2 * t * std::abs(high - low)});
        }
    };
    if (reach.begin >= 0)
        part(reach.begin, reach.end);
    else if (reach.end <= 0)
        part(reach.end, reach.begin);
    else {
        part(0, reach.begin);
        part(0, reach.end);
    }
    std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.u < b.u; });
    return samples;
}

} // namespace

LightPath light_path(const Air& air, const LightGrid& grid, const PlanetRay& ray, std::size_t points)
{
    const std::size_t groups = lane_groups(air.wavelengths);
    const std::vector<Sample> samples = samples_along(ray, air.height_m, points);
    LightPath path;
    path.start_radius = ray.radius_at(ray.start());
    path.rayleigh.assign(groups * samples.size(), Lanes{});
    path.mie = path.rayleigh;
    path.ground.assign(groups, Lanes{});
    Columns way;
    double at = samples.empty() ? ray.start() : ray.reach(air.height_m).begin;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double u = samples[i].u, altitude = std::max(0.0, ray.altitude(u)), mu = ray.mu(u);
        way = way + columns_along(air, ray, at, u);
        at = u;
        path.places.push_back({altitude,
                               u - ray.start(),
                               1 / ray.radius_at(u),
                               static_cast<float>(mu),
                               static_cast<float>(std::sqrt(std::max(0.0, 1 - mu * mu))),
                               grid.altitude_at(static_cast<float>(altitude)),
                               grid.out_angle_at(arc_cosine(static_cast<float>(mu)))});
        const Columns density = air.density(altitude);
        for (std::size_t w = 0; w < air.wavelengths; ++w) {
            const double reaching = samples[i].weight * air.transmittance(w, way);
            const std::size_t entry = w / kLanes * samples.size() + i;
            path.rayleigh[entry][w % kLanes] =
                static_cast<float>(reaching * air.rayleigh[w] * density.rayleigh);
            path.mie[entry][w % kLanes] = static_cast<float>(reaching * air.mie_scattering[w] * density.mie);
        }
    }
    path.hits_ground = ray.hits_ground();
    if (!path.hits_ground) return path;
    way = way + columns_along(air, ray, at, ray.ground());
    path.ground_along = ray.ground() - ray.start();
    for (std::size_t w = 0; w < air.wavelengths; ++w)
        path.ground[w / kLanes][w % kLanes] = static_cast<float>(air.transmittance(w, way));
    return path;
}

} // namespace renderer
