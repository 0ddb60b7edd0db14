#include "renderer/sky/sky_view.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/arc_cosine.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/phase.h"
#include "renderer/sky/shadow_edges.h"
#include "renderer/sky/sky_sun.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {
constexpr std::size_t kParts = 3;
}

SkyView::SkyView(const Air& air,
                 const ColumnTable& columns,
                 const ScatteredLight* scattered,
                 double altitude,
                 double mu_sun,
                 ThreadPool& pool,
                 const SkyViewSize& size)
    : air_(air), columns_(columns), size_(size), altitude_(altitude), mu_sun_(mu_sun),
      sun_sine_(std::sqrt(std::max(0.0, (1 - mu_sun) * (1 + mu_sun)))),
      horizon_(-std::sqrt(altitude * (2 * air.radius_m + altitude)) / (air.radius_m + altitude)),
      groups_(lane_groups(air.wavelengths)), light_(2 * size.rows * size.azimuths * groups_ * kParts)
{
    pool.run(2 * size_.rows, [&](std::size_t index, unsigned) { fill(index, scattered); });
}

// Squares of equal steps from the horizon: the first row above looks along it, the first below just under it.
double SkyView::mu_of(std::size_t index) const
{
    const bool sky = index < size_.rows;
    const double t =
        static_cast<double>(sky ? index : index - size_.rows) / static_cast<double>(size_.rows - 1);
    const double mu = horizon_ + (sky ? 1 - horizon_ : -1 - horizon_) * t * t;
    return sky ? std::max(mu, horizon_ + 1e-12) : std::min(mu, horizon_ - 1e-9);
}

void SkyView::fill(std::size_t index, const ScatteredLight* scattered)
{
    const double mu = mu_of(index), sine = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu)));
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
        const std::size_t n = path.places.size();
        Lanes* const out = &light_[(index * size_.azimuths + a) * groups_ * kParts];
        for (std::size_t i = 0; i < n; ++i) {
            const LightPath::Place& place = path.places[i];
            const double mu_sun = (path.start_radius * mu_sun_ + place.along * nu) * place.inverse_radius;
            const SunThroughAir sun(air_, columns_, place.altitude, std::clamp(mu_sun, -1.0, 1.0));
            if (sun.hidden()) continue;
            for (std::size_t g = 0; g < groups_; ++g) {
                const Lanes reaching = sun.transmittance(air_, g);
                out[g * kParts] += path.rayleigh[g * n + i] * reaching;
                out[g * kParts + 1] += path.mie[g * n + i] * reaching;
            }
        }
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

void SkyView::row(double mu, Row& row) const
{
    const bool sky = mu >= horizon_;
    const double range = sky ? 1 - horizon_ : 1 + horizon_;
    const double t = std::sqrt(std::clamp(std::abs(mu - horizon_) / std::max(1e-300, range), 0.0, 1.0));
    const double at = t * static_cast<double>(size_.rows - 1);
    const auto below = std::min(static_cast<std::size_t>(at), size_.rows - 2);
    const Lanes share = splat(static_cast<float>(at - static_cast<double>(below)));
    const std::size_t width = size_.azimuths * groups_ * kParts;
    const Lanes* const low = &light_[((sky ? 0 : size_.rows) + below) * width];
    row.view_ = this;
    row.mu_ = static_cast<float>(mu);
    row.sine_ = static_cast<float>(std::sqrt(std::max(0.0, (1 - mu) * (1 + mu))));
    row.light_.resize(width);
    for (std::size_t i = 0; i < width; ++i)
        row.light_[i] = low[i] + (low[i + width] - low[i]) * share;
}

Lanes SkyView::Row::radiance(std::size_t group, float azimuth_cosine) const
{
    const SkyView& view = *view_;
    const float at =
        arc_cosine(azimuth_cosine) * static_cast<float>(static_cast<double>(view.size_.azimuths - 1) / kPi);
    const auto below = std::min(static_cast<std::size_t>(at), view.size_.azimuths - 2);
    const Lanes share = splat(at - static_cast<float>(below));
    const std::size_t step = view.groups_ * kParts;
    const Lanes* const low = &light_[below * step + group * kParts];
    const auto mix = [&](std::size_t part) { return low[part] + (low[step + part] - low[part]) * share; };
    const double nu = static_cast<double>(mu_) * view.mu_sun_ +
                      static_cast<double>(sine_ * azimuth_cosine) * view.sun_sine_;
    const double turned = std::clamp(nu, -1.0, 1.0);
    return mix(0) * splat(static_cast<float>(rayleigh_phase(turned))) +
           mix(1) * splat(static_cast<float>(mie_phase(view.air_.phase, view.air_.g, turned))) + mix(2);
}

Spectrum SkyView::radiance(double mu, double azimuth_cosine) const
{
    Row one;
    row(mu, one);
    Spectrum result{};
    for (std::size_t w = 0; w < air_.wavelengths; ++w)
        result[w] = static_cast<double>(
            one.radiance(w / kLanes, static_cast<float>(std::clamp(azimuth_cosine, -1.0, 1.0)))[w % kLanes]);
    return result;
}

} // namespace renderer
