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
std::vector<Sample> samples_along(const PlanetRay& ray,
                                  PlanetRay::Reach reach,
                                  std::size_t points,
                                  const std::vector<double>& edges)
{
    if (!(reach.end > reach.begin)) return {};
    std::vector<double> stops{reach.begin, reach.end, 0};
    for (const double s : edges)
        stops.push_back(ray.start() + s);
    std::erase_if(stops, [&](double u) { return !(u >= reach.begin && u <= reach.end); });
    std::sort(stops.begin(), stops.end());
    const GaussLegendre rule(points);
    std::vector<Sample> samples;
    for (std::size_t part = 0; part + 1 < stops.size(); ++part) {
        const bool rising = stops[part] >= 0;
        const double low = stops[rising ? part : part + 1], length = stops[part + 1] - stops[part];
        for (std::size_t i = 0; i < points && length > 0; ++i) {
            const double t = rule.x[rising ? i : points - 1 - i];
            samples.push_back({low + (rising ? length : -length) * t * t,
                               rule.weight[rising ? i : points - 1 - i] * 2 * t * length});
        }
    }
    return samples;
}

} // namespace

LightPath light_path(const Air& air,
                     const LightGrid* grid,
                     const PlanetRay& ray,
                     std::size_t points,
                     const std::vector<double>& edges,
                     double far_m)
{
    const std::size_t groups = lane_groups(air.wavelengths);
    PlanetRay::Reach reach = ray.reach(air.height_m);
    const bool ends_in_air = ray.start() + far_m < reach.end;
    if (ends_in_air) reach.end = ray.start() + far_m;
    const std::vector<Sample> samples = samples_along(ray, reach, points, edges);
    LightPath path;
    path.start_radius = ray.radius_at(ray.start());
    path.rayleigh.assign(groups * samples.size(), Lanes{});
    path.mie = path.rayleigh;
    path.ground.assign(groups, Lanes{});
    Columns way;
    double at = samples.empty() ? ray.start() : reach.begin;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double u = samples[i].u, altitude = std::max(0.0, ray.altitude(u)), mu = ray.mu(u);
        way = way + columns_along(air, ray, at, u);
        at = u;
        path.places.push_back({altitude,
                               u - ray.start(),
                               1 / ray.radius_at(u),
                               static_cast<float>(mu),
                               static_cast<float>(std::sqrt(std::max(0.0, 1 - mu * mu))),
                               grid ? grid->altitude_at(static_cast<float>(altitude)) : Between{},
                               grid ? grid->out_angle_at(arc_cosine(static_cast<float>(mu))) : Between{}});
        const Columns density = air.density(altitude);
        for (std::size_t w = 0; w < air.wavelengths; ++w) {
            const double reaching = samples[i].weight * air.transmittance(w, way);
            const std::size_t entry = w / kLanes * samples.size() + i;
            path.rayleigh[entry][w % kLanes] =
                static_cast<float>(reaching * air.rayleigh[w] * density.rayleigh);
            path.mie[entry][w % kLanes] = static_cast<float>(reaching * air.mie_scattering[w] * density.mie);
        }
    }
    path.hits_ground = !ends_in_air && ray.hits_ground();
    if (!path.hits_ground) return path;
    way = way + columns_along(air, ray, at, ray.ground());
    path.ground_along = ray.ground() - ray.start();
    for (std::size_t w = 0; w < air.wavelengths; ++w)
        path.ground[w / kLanes][w % kLanes] = static_cast<float>(air.transmittance(w, way));
    return path;
}

} // namespace renderer
