#include "renderer/sky/scattered_light.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/arc_cosine.h"
#include "renderer/sky/phase.h"
#include "renderer/sky/sky_sun.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

constexpr std::size_t kMostOrders = 100;
constexpr double kSettled = 1e-4;                              // an order's share of all
constexpr std::size_t kPointsFromEye = 48, kPointsOfPart = 20; // of a whole line of sight, and of a part

Lanes mix(Lanes a, Lanes b, float share)
{
    return a + (b - a) * splat(share);
}

} // namespace

struct ScatteredLight::Site {
    Directions directions;
    std::vector<LightPath> paths; // one a mu
    ScatterKernel kernel;
    double altitude;

    Site(const Air& air, const LightGrid& grid, std::size_t i)
        : directions(directions_at(air, grid.resolution(), grid.altitude(i))),
          kernel(air, grid.resolution(), directions), altitude(grid.altitude(i))
    {
        for (const double mu : directions.mu)
            paths.push_back(
                light_path(air, &grid, PlanetRay(air.radius_m, altitude, mu), grid.resolution().points));
    }
    Site(const Site&) = delete; // the kernel refers to its directions
};

struct ScatteredLight::Scratch {
    std::vector<Lanes> light, kernel;
};

ScatteredLight::ScatteredLight(const Air& air,
                               const ColumnTable& columns,
                               const GridResolution& resolution,
                               ThreadPool& pool,
                               const std::stop_token& stop)
    : air_(air), columns_(columns), grid_(air, resolution),
      has_mie_(
          std::any_of(air.mie_scattering.begin(), air.mie_scattering.end(), [](double b) { return b > 0; })),
      albedo_over_pi_(lane_groups(air.wavelengths)), total_(lane_groups(air.wavelengths))
{
    for (std::size_t w = 0; w < air.wavelengths; ++w)
        albedo_over_pi_[w / kLanes][w % kLanes] = static_cast<float>(air.ground_albedo[w] / kPi);
    std::vector<std::unique_ptr<Site>> sites(grid_.altitudes());
    pool.run(sites.size(),
             [&](std::size_t i, unsigned) { sites[i] = std::make_unique<Site>(air_, grid_, i); });
    for (std::size_t group = 0; group < total_.size(); ++group)
        build(group, sites, pool, stop);
}

ScatteredLight::Source ScatteredLight::empty_source() const
{
    const std::size_t places = grid_.altitudes() * grid_.suns(), out = grid_.resolution().out_angles;
    return {std::vector<Moments>(places),
            std::vector<Lanes>(has_mie_ ? places * out * out : 0),
            std::vector<Lanes>(grid_.suns())};
}

void ScatteredLight::build(std::size_t group,
                           const Sites& sites,
                           ThreadPool& pool,
                           const std::stop_token& stop)
{
    const std::size_t items = grid_.altitudes() * grid_.suns();
    std::vector<Scratch> scratch(pool.size());
    Source& total = total_[group];
    total = empty_source();
    Source current = empty_source(), next = empty_source();
    pool.run(
        items,
        [&](std::size_t item, unsigned worker) {
            const Site& site = *sites[item / grid_.suns()];
            light_from_sun(group, site, item % grid_.suns(), scratch[worker].light);
            scatter(group, site, item, scratch[worker], current);
        },
        stop);
    Lanes before{};
    for (std::size_t order = 2; order <= kMostOrders && !stop.stop_requested(); ++order) {
        const Lanes all = sum_of(total), now = sum_of(current);
        Lanes tail{};
        bool settled = true;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const float ratio = before[lane] > 0 ? std::min(0.999f, now[lane] / before[lane]) : 0;
            tail[lane] = order > 2 ? ratio / (1 - ratio) : 0;
            settled = settled && now[lane] <= static_cast<float>(kSettled) * all[lane];
        }
        orders_ = std::max(orders_, order);
        if (settled || order == kMostOrders) {
            add(current, splat(1) + tail, total);
            break;
        }
        add(current, splat(1), total);
        before = now;
        pool.run(
            items,
            [&](std::size_t item, unsigned worker) {
                const Site& site = *sites[item / grid_.suns()];
                light_from(current, group, site, item % grid_.suns(), scratch[worker].light);
                scatter(group, site, item, scratch[worker], next);
            },
            stop);
        std::swap(current, next);
    }
}

Lanes ScatteredLight::sum_of(const Source& source)
{
    Lanes sum{};
    for (const Moments& moments : source.moments)
        sum += moments.xx + moments.yy + moments.zz;
    return sum;
}

void ScatteredLight::add(const Source& more, Lanes times, Source& to)
{
    for (std::size_t i = 0; i < to.moments.size(); ++i) {
        to.moments[i].xx += more.moments[i].xx * times;
        to.moments[i].yy += more.moments[i].yy * times;
        to.moments[i].zz += more.moments[i].zz * times;
        to.moments[i].xz += more.moments[i].xz * times;
    }
    for (std::size_t i = 0; i < to.mie.size(); ++i)
        to.mie[i] += more.mie[i] * times;
    for (std::size_t i = 0; i < to.ground.size(); ++i)
        to.ground[i] += more.ground[i] * times;
}

void ScatteredLight::light_from_sun(std::size_t group,
                                    const Site& site,
                                    std::size_t sun,
                                    std::vector<Lanes>& light) const
{
    const auto [sun_sine, sun_mu] = sin_cos_deg(grid_.sun_zenith_deg(sun));
    const std::size_t azimuths = grid_.resolution().azimuths;
    light.assign(site.paths.size() * azimuths, Lanes{});
    for (std::size_t j = 0; j < site.paths.size(); ++j) {
        const LightPath& path = site.paths[j];
        const std::size_t places = path.places.size();
        for (std::size_t p = 0; p < azimuths; ++p) {
            const double nu =
                std::clamp(site.directions.mu[j] * sun_mu +
                               site.directions.sine[j] * sun_sine * site.directions.azimuth_cosine[p],
                           -1.0,
                           1.0);
            const Lanes rayleigh = splat(static_cast<float>(rayleigh_phase(nu)));
            const Lanes mie = splat(static_cast<float>(mie_phase(air_.phase, air_.g, nu)));
            Lanes sum{};
            for (std::size_t i = 0; i < places; ++i) {
                const LightPath::Place& place = path.places[i];
                const double mu_sun = (path.start_radius * sun_mu + place.along * nu) * place.inverse_radius;
                sum += (path.rayleigh[group * places + i] * rayleigh + path.mie[group * places + i] * mie) *
                       SunThroughAir(air_, columns_, place.altitude, std::clamp(mu_sun, -1.0, 1.0))
                           .transmittance(air_, group);
            }
            if (path.hits_ground) {
                const double mu_sun = (path.start_radius * sun_mu + path.ground_along * nu) / air_.radius_m;
                if (mu_sun > 0)
                    sum += path.ground[group] * albedo_over_pi_[group] * splat(static_cast<float>(mu_sun)) *
                           SunThroughAir(air_, columns_, 0, std::min(1.0, mu_sun)).transmittance(air_, group);
            }
            light[j * azimuths + p] = sum;
        }
    }
}

void ScatteredLight::light_from(const Source& source,
                                std::size_t group,
                                const Site& site,
                                std::size_t sun,
                                std::vector<Lanes>& light) const
{
    const auto [sun_sine, sun_mu] = sin_cos_deg(grid_.sun_zenith_deg(sun));
    const std::size_t azimuths = grid_.resolution().azimuths;
    light.resize(site.paths.size() * azimuths);
    for (std::size_t j = 0; j < site.paths.size(); ++j)
        for (std::size_t p = 0; p < azimuths; ++p) {
            const double nu = site.directions.mu[j] * sun_mu +
                              site.directions.sine[j] * sun_sine * site.directions.azimuth_cosine[p];
            light[j * azimuths + p] = gather(source, site.paths[j], group, sun_mu, std::clamp(nu, -1.0, 1.0));
        }
}

// What leaves one place under one sun, and under the lowest places the ground.
void ScatteredLight::scatter(
    std::size_t group, const Site& site, std::size_t item, Scratch& scratch, Source& to) const
{
    const std::size_t out = grid_.resolution().out_angles, azimuths = grid_.resolution().azimuths;
    to.moments[item] = site.kernel.moments(scratch.light.data());
    if (has_mie_) site.kernel.scatter(scratch.light.data(), &to.mie[item * out * out], scratch.kernel);
    if (item >= grid_.suns()) return;
    Lanes irradiance{};
    for (std::size_t j = 0; j < grid_.resolution().sky; ++j)
        for (std::size_t p = 0; p < azimuths; ++p)
            irradiance += scratch.light[j * azimuths + p] *
                          splat(static_cast<float>(site.directions.weight[j] * site.directions.mu[j] *
                                                   site.directions.azimuth_weight[p]));
    to.ground[item] = irradiance * albedo_over_pi_[group];
}

Lanes ScatteredLight::gather(
    const Source& source, const LightPath& path, std::size_t group, double mu_sun, double nu) const
{
    const std::size_t places = path.places.size(), suns = grid_.suns(), out = grid_.resolution().out_angles;
    Lanes sum{};
    for (std::size_t n = 0; n < places; ++n) {
        const LightPath::Place& place = path.places[n];
        const double sun = (path.start_radius * mu_sun + place.along * nu) * place.inverse_radius;
        const float c = static_cast<float>(std::clamp(sun, -1.0, 1.0));
        Between at_sun;
        if (!grid_.sun_at(arc_cosine(c), at_sun)) continue;
        const float sun_sine = std::sqrt(std::max(0.0f, 1 - c * c)), sines = place.sine * sun_sine;
        const float turn = sines > 1e-6f ? (static_cast<float>(nu) - place.mu * c) / sines : 1.0f;
        const float azimuth = std::clamp(turn, -1.0f, 1.0f);

        const std::size_t corner = place.at_altitude.below * suns + at_sun.below;
        const float high = place.at_altitude.share, late = at_sun.share;
        const float weights[] = {(1 - high) * (1 - late), (1 - high) * late, high * (1 - late), high * late};
        const std::size_t corners[] = {corner, corner + 1, corner + suns, corner + suns + 1};

        const float x = place.sine * azimuth, z = place.mu,
                    y2 = std::max(0.0f, place.sine * place.sine - x * x);
        Lanes rayleigh{};
        for (int k = 0; k < 4; ++k) {
            const Moments& m = source.moments[corners[k]];
            rayleigh += (m.xx * splat(1 + x * x) + m.yy * splat(1 + y2) + m.zz * splat(1 + z * z) +
                         m.xz * splat(2 * x * z)) *
                        splat(weights[k]);
        }
        sum += rayleigh * path.rayleigh[group * places + n];
        if (!has_mie_) continue;
        const Between at_azimuth = grid_.out_angle_at(arc_cosine(azimuth));
        const std::size_t offset = place.at_angle.below * out + at_azimuth.below;
        Lanes mie{};
        for (int k = 0; k < 4; ++k) {
            const Lanes* from = &source.mie[corners[k] * out * out + offset];
            mie += mix(mix(from[0], from[1], at_azimuth.share),
                       mix(from[out], from[out + 1], at_azimuth.share),
                       place.at_angle.share) *
                   splat(weights[k]);
        }
        sum += mie * path.mie[group * places + n];
    }
    if (!path.hits_ground) return sum;
    const double sun = (path.start_radius * mu_sun + path.ground_along * nu) / air_.radius_m;
    Between at_sun;
    if (!grid_.sun_at(arc_cosine(static_cast<float>(std::clamp(sun, -1.0, 1.0))), at_sun)) return sum;
    return sum + path.ground[group] *
                     mix(source.ground[at_sun.below], source.ground[at_sun.below + 1], at_sun.share);
}

std::size_t ScatteredLight::size_bytes() const
{
    std::size_t bytes = 0;
    for (const Source& source : total_)
        bytes += source.moments.capacity() * sizeof(Moments) +
                 (source.mie.capacity() + source.ground.capacity()) * sizeof(Lanes);
    return bytes;
}

LightPath ScatteredLight::path(const PlanetRay& ray, double far_m) const
{
    return light_path(air_, &grid_, ray, std::isfinite(far_m) ? kPointsOfPart : kPointsFromEye, {}, far_m);
}

Spectrum ScatteredLight::radiance(const LightPath& path, double mu_sun, double nu) const
{
    Spectrum result{};
    for (std::size_t group = 0; group < total_.size(); ++group) {
        const Lanes value = gather(total_[group], path, group, mu_sun, nu);
        for (std::size_t lane = 0; lane < kLanes && group * kLanes + lane < air_.wavelengths; ++lane)
            result[group * kLanes + lane] = static_cast<double>(value[lane]);
    }
    return result;
}

} // namespace renderer
