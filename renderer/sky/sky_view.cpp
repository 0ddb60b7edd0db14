#include "renderer/sky/sky_view.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/arc_cosine.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/phase.h"
#include "renderer/sky/shadow_edges.h"
#include "renderer/sky/sky_sun.h"
#include "renderer/sky/sunlit_path.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace renderer {

SkyView::SkyView(const Air& air,
                 const ColumnTable& columns,
                 const ScatteredLight* scattered,
                 double altitude,
                 double mu_sun,
                 ThreadPool& pool,
                 const SkyViewSize& size)
    : air_(air), columns_(columns), size_(size), rows_(air, altitude, size.rows), altitude_(altitude),
      mu_sun_(mu_sun), sun_sine_(std::sqrt(std::max(0.0, (1 - mu_sun) * (1 + mu_sun)))),
      groups_(lane_groups(air.wavelengths)), light_(2 * size.rows * size.azimuths * groups_ * kParts)
{
    pool.run(rows_.count(), [&](std::size_t index, unsigned) { fill(index, scattered); });
}

void SkyView::fill(std::size_t index, const ScatteredLight* scattered)
{
    const double mu = rows_.mu(index), sine = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu)));
    const PlanetRay ray(air_.radius_m, altitude_, mu);
    const LightPath whole = light_path(air_, nullptr, ray, size_.points);
    LightPath to_gather;
    if (scattered) to_gather = scattered->path(ray);
    for (std::size_t a = 0; a < size_.azimuths; ++a) {
        const double cosine =
            sin_cos_deg(180 * static_cast<double>(a) / static_cast<double>(size_.azimuths - 1)).second;
        const double nu = std::clamp(mu * mu_sun_ + sine * sun_sine_ * cosine, -1.0, 1.0);
        const std::vector<double> edges = shadow_edges(air_.radius_m, {altitude_, mu, mu_sun_, nu});
        LightPath cut;
        if (!edges.empty()) cut = light_path(air_, nullptr, ray, size_.points, edges);
        const LightPath& path = edges.empty() ? whole : cut;
        Lanes* const out = &light_[(index * size_.azimuths + a) * groups_ * kParts];
        add_sunlight(air_, columns_, path, mu_sun_, nu, out, kParts);
        Spectrum more{};
        if (scattered) more = scattered->radiance(to_gather, mu_sun_, nu);
        const double sun_on_ground =
            path.hits_ground ? (path.start_radius * mu_sun_ + path.ground_along * nu) / air_.radius_m : 0;
        const SunThroughAir sun(air_, columns_, 0, std::clamp(sun_on_ground, 0.0, 1.0));
        for (std::size_t w = 0; w < air_.wavelengths; ++w) {
            const std::size_t g = w / kLanes, lane = w % kLanes;
            if (sun_on_ground > 0)
                more[w] += air_.ground_albedo[w] / kPi * sun_on_ground *
                           static_cast<double>(path.ground[g][lane]) *
                           static_cast<double>(sun.transmittance(air_, g)[lane]);
            out[g * kParts + 2][lane] = static_cast<float>(more[w]);
        }
    }
}

bool SkyView::row(double mu, Lanes* light) const
{
    ViewRows::Place place;
    if (!rows_.find(mu, place)) return false;
    const std::size_t width = size_.azimuths * groups_ * kParts;
    const Lanes* const low = &light_[place.row * width];
    for (std::size_t i = 0; i < width; ++i)
        light[i] = low[i] + (low[i + width] - low[i]) * splat(place.share);
    return true;
}

void SkyView::radiance(double mu, float azimuth_cosine, Lanes* groups) const
{
    std::fill_n(groups, groups_, Lanes{});
    ViewRows::Place place;
    if (!rows_.find(mu, place)) return;
    const AnglePlace at = angle_place(arc_cosine(azimuth_cosine), size_.azimuths);
    const std::size_t step = groups_ * kParts, width = size_.azimuths * step;
    const auto sine = static_cast<float>(std::sqrt(std::max(0.0, (1 - mu) * (1 + mu))));
    const double nu =
        std::clamp(mu * mu_sun_ + static_cast<double>(sine * azimuth_cosine) * sun_sine_, -1.0, 1.0);
    const Lanes rayleigh = splat(static_cast<float>(rayleigh_phase(nu))),
                mie = splat(static_cast<float>(mie_phase(air_.phase, air_.g, nu)));
    for (std::size_t g = 0; g < groups_; ++g) {
        const Lanes* const low = &light_[place.row * width + at.column * step + g * kParts];
        const Lanes* const high = low + width;
        const auto part = [&](std::size_t i) {
            const Lanes left = low[i] + (high[i] - low[i]) * splat(place.share);
            const Lanes right = low[step + i] + (high[step + i] - low[step + i]) * splat(place.share);
            return left + (right - left) * splat(at.share);
        };
        groups[g] = part(0) * rayleigh + part(1) * mie + part(2);
    }
}

Spectrum SkyView::radiance(double mu, double azimuth_cosine) const
{
    std::array<Lanes, lane_groups(kMostWavelengths)> groups;
    radiance(mu, static_cast<float>(std::clamp(azimuth_cosine, -1.0, 1.0)), groups.data());
    Spectrum result{};
    for (std::size_t w = 0; w < air_.wavelengths; ++w)
        result[w] = static_cast<double>(groups[w / kLanes][w % kLanes]);
    return result;
}

} // namespace renderer
