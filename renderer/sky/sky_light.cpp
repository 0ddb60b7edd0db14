#include "renderer/sky/sky_light.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/phase.h"
#include "renderer/sky/sky_sun.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace renderer {

namespace {

constexpr std::size_t kPointsBetween = 20;

// Where a point of the world stands over the planet, `altitude` above whose ground is the world's origin.
struct Standing {
    double altitude = 0, radius = 1;
    Vec3d up;

    Standing(double planet_radius, double origin_altitude, Vec3d p)
    {
        const double h = origin_altitude + p.y, across2 = p.x * p.x + p.z * p.z;
        radius = std::sqrt(across2 + (planet_radius + h) * (planet_radius + h));
        altitude = std::max(0.0, (across2 + h * (2 * planet_radius + h)) / (planet_radius + radius));
        up = Vec3d{p.x, planet_radius + h, p.z} / radius;
    }
};

Vec3d direction_of_sun(const SkySunDescription& sun)
{
    const auto [sine, cosine] = sin_cos_deg(sun.elevation_deg);
    const auto [east, north] = sin_cos_deg(sun.azimuth_deg);
    return {cosine * east, sine, -cosine * north};
}

} // namespace

SkyLight::SkyLight(const AtmosphereDescription& description, ThreadPool& pool, std::stop_token stop)
    : sky_(description, pool, std::move(stop)), color_(sky_.air().wavelength_nm, description.sun.irradiance),
      altitude_(description.altitude_m), sun_radius_(description.sun.angular_radius_deg * (kPi / 180)),
      limb_darkening_(description.sun.limb_darkening), to_sun_(direction_of_sun(description.sun)),
      view_(sky_.air(), sky_.columns(), sky_.scattered(), altitude_, to_sun_.y, pool)
{
    const auto [east, north] = sin_cos_deg(description.sun.azimuth_deg);
    sun_x_ = east;
    sun_z_ = -north;
}

Rgb SkyLight::radiance(Vec3d direction) const
{
    const double across = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    const double azimuth = across > 0 ? (direction.x * sun_x_ + direction.z * sun_z_) / across : 1;
    return color_(view_.radiance(direction.y, azimuth));
}

// 1 - u (1 - mu), over its mean, with u = 0.6 for visible light.  Source: Cox, "Allen's Astrophysical Quantities", 2000.
double SkyLight::limb(double share_of_radius2) const
{
    constexpr double kDarkening = 0.6;
    if (!limb_darkening_) return 1;
    return (1 - kDarkening * (1 - std::sqrt(std::max(0.0, 1 - share_of_radius2)))) / (1 - kDarkening / 3);
}

Rgb SkyLight::sun_radiance(Vec3d direction) const
{
    // Chord instead of angle: it keeps its digits.
    const Vec3d apart = direction - to_sun_;
    const double sine2 = dot(apart, apart) * (1 - dot(apart, apart) / 4), edge = sin_cos(sun_radius_).first;
    if (!(sun_radius_ > 0) || sine2 >= edge * edge || dot(direction, to_sun_) <= 0) return {};
    const double disk = kPi * edge * edge;
    return color_(sky_.transmittance(altitude_, std::clamp(direction.y, -1.0, 1.0))) *
           static_cast<float>(limb(sine2 / (edge * edge)) / disk);
}

Rgb SkyLight::sun_irradiance() const
{
    return color_(sky_.transmittance(altitude_, to_sun_.y));
}

SkyLight::Between SkyLight::between(Vec3d from, Vec3d to) const
{
    const Air& air = sky_.air();
    const Standing eye(air.radius_m, altitude_, from), end(air.radius_m, altitude_, to);
    const double distance = length(to - from);
    if (!(distance > 0)) return {};
    const Vec3d view = (to - from) / distance;
    const double mu = std::clamp(dot(eye.up, view), -1.0, 1.0),
                 mu_sun = std::clamp(dot(eye.up, to_sun_), -1.0, 1.0);
    const double nu = std::clamp(dot(view, to_sun_), -1.0, 1.0);
    const PlanetRay ray(air.radius_m, eye.altitude, mu);
    const PlanetRay::Reach reach = ray.reach(air.height_m);
    const double begin = reach.begin, stop = std::min(ray.start() + distance, reach.end);
    const Columns way = columns_along(air, ray, begin, stop);
    Spectrum transmittance{}, added{};
    for (std::size_t w = 0; w < air.wavelengths; ++w)
        transmittance[w] = air.transmittance(w, way);
    const GaussLegendre rule(kPointsBetween);
    const double rayleigh = rayleigh_phase(nu), mie = mie_phase(air.phase, air.g, nu);
    for (std::size_t i = 0; i < kPointsBetween && stop > begin; ++i) {
        const double u = begin + (stop - begin) * rule.x[i], weight = (stop - begin) * rule.weight[i];
        const double altitude = std::max(0.0, ray.altitude(u));
        const double sun = (eye.radius * mu_sun + (u - ray.start()) * nu) / ray.radius_at(u);
        const SunThroughAir light(air, sky_.columns(), altitude, std::clamp(sun, -1.0, 1.0));
        if (light.hidden()) continue;
        const Columns density = air.density(altitude), here = columns_along(air, ray, begin, u);
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            added[w] +=
                weight * air.transmittance(w, here) *
                static_cast<double>(light.transmittance(air, w / kLanes)[w % kLanes]) *
                (air.rayleigh[w] * density.rayleigh * rayleigh + air.mie_scattering[w] * density.mie * mie);
    }
    if (const ScatteredLight* scattered = sky_.scattered()) {
        // What all of the line of sight gathers, without what lies beyond.
        const double end_mu = std::clamp(dot(end.up, view), -1.0, 1.0);
        const Spectrum all = scattered->radiance(scattered->path(ray), mu_sun, nu);
        const Spectrum beyond =
            scattered->radiance(scattered->path(PlanetRay(air.radius_m, end.altitude, end_mu)),
                                std::clamp(dot(end.up, to_sun_), -1.0, 1.0),
                                nu);
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            added[w] += std::max(0.0, all[w] - transmittance[w] * beyond[w]);
    }
    return {color_.share(transmittance), color_(added)};
}

SkyPanorama SkyLight::panorama(std::size_t width, std::size_t height, ThreadPool& pool) const
{
    SkyPanorama picture{width, height, std::vector<Rgb>(width * height)};
    std::vector<float> azimuth(width);
    for (std::size_t x = 0; x < width; ++x) {
        const auto [east, north] =
            sin_cos_deg(360 * ((static_cast<double>(x) + 0.5) / static_cast<double>(width) - 0.5));
        azimuth[x] = static_cast<float>(std::clamp(east * sun_x_ - north * sun_z_, -1.0, 1.0));
    }
    const std::size_t groups = lane_groups(sky_.air().wavelengths);
    pool.run(height, [&](std::size_t y, unsigned) {
        SkyView::Row row;
        view_.row(sin_cos_deg(90 - 180 * (static_cast<double>(y) + 0.5) / static_cast<double>(height)).first,
                  row);
        std::array<Lanes, lane_groups(kMostWavelengths)> light{};
        for (std::size_t x = 0; x < width; ++x) {
            for (std::size_t g = 0; g < groups; ++g)
                light[g] = row.radiance(g, azimuth[x]);
            picture.pixels[y * width + x] = color_.of_lanes(light.data());
        }
    });
    return picture;
}

} // namespace renderer
