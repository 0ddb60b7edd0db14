#include "renderer/sky/aerial_view.h"

#include "renderer/math/fast_exp.h"
#include "renderer/math/transcendental.h"
#include "renderer/sky/arc_cosine.h"
#include "renderer/sky/light_path.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/phase.h"
#include "renderer/sky/sunlit_path.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {
constexpr std::size_t kParts = 3;
constexpr std::size_t kPoints = 20; // of a part of a line of sight, a side of its closest approach
} // namespace

AerialView::AerialView(const Air& air,
                       const ColumnTable& columns,
                       const ScatteredLight* scattered,
                       double altitude,
                       double mu_sun,
                       double far_m,
                       ThreadPool& pool,
                       const AerialSize& size)
    : air_(air), columns_(columns), size_(size), rows_(air, altitude, size.rows), altitude_(altitude),
      mu_sun_(mu_sun), sun_sine_(std::sqrt(std::max(0.0, (1 - mu_sun) * (1 + mu_sun)))), far_(far_m),
      groups_(lane_groups(air.wavelengths)),
      light_(rows_.count() * (size.slices + 1) * size.azimuths * groups_ * kParts),
      depth_(rows_.count() * (size.slices + 1) * groups_)
{
    for (std::size_t i = 0; i <= size.slices; ++i)
        ends_.push_back(
            (1 - sin_cos_deg(180 * static_cast<double>(i) / static_cast<double>(size.slices)).second) / 2);
    pool.run(rows_.count(), [&](std::size_t row, unsigned) { fill(row, scattered); });
}

AerialView::Way AerialView::way(double mu) const
{
    const PlanetRay ray(air_.radius_m, altitude_, mu);
    const PlanetRay::Reach reach = ray.reach(air_.height_m);
    const double begin = reach.begin - ray.start(), end = std::min(far_, reach.end - ray.start());
    return end > begin ? Way{begin, end} : Way{};
}

void AerialView::fill(std::size_t row, const ScatteredLight* scattered)
{
    const double mu = rows_.mu(row), sine = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu)));
    const PlanetRay ray(air_.radius_m, altitude_, mu);
    const Way whole = way(mu);
    for (std::size_t slice = 1; slice <= size_.slices && whole.end > whole.begin; ++slice) {
        const double far = whole.begin + (whole.end - whole.begin) * ends_[slice];
        const Columns columns = columns_along(air_, ray, ray.start() + whole.begin, ray.start() + far);
        const std::size_t entry = row * (size_.slices + 1) + slice;
        for (std::size_t w = 0; w < air_.wavelengths; ++w)
            depth_[entry * groups_ + w / kLanes][w % kLanes] =
                static_cast<float>(air_.optical_depth(w, columns));
        LightPath path =
            scattered ? scattered->path(ray, far) : light_path(air_, nullptr, ray, kPoints, {}, far);
        path.hits_ground = false; // what stands there is seen instead
        for (std::size_t a = 0; a < size_.azimuths; ++a) {
            const double cosine =
                sin_cos_deg(180 * static_cast<double>(a) / static_cast<double>(size_.azimuths - 1)).second;
            const double nu = std::clamp(mu * mu_sun_ + sine * sun_sine_ * cosine, -1.0, 1.0);
            Lanes* const out = &light_[(entry * size_.azimuths + a) * groups_ * kParts];
            add_sunlight(air_, columns_, path, mu_sun_, nu, out, kParts);
            if (!scattered) continue;
            const Spectrum more = scattered->radiance(path, mu_sun_, nu);
            for (std::size_t w = 0; w < air_.wavelengths; ++w)
                out[w / kLanes * kParts + 2][w % kLanes] = static_cast<float>(more[w]);
        }
    }
}

void AerialView::look(
    double mu, float azimuth_cosine, double distance, Lanes* transmittance, Lanes* added) const
{
    std::fill_n(transmittance, groups_, splat(1));
    std::fill_n(added, groups_, Lanes{});
    ViewRows::Place place;
    const Way whole = way(mu);
    if (!(whole.end > whole.begin) || !rows_.find(mu, place)) return;
    const double share = std::clamp((distance - whole.begin) / (whole.end - whole.begin), 0.0, 1.0);
    const std::size_t slice =
        angle_place(arc_cosine(static_cast<float>(1 - 2 * share)), size_.slices + 1).column;
    const double from = ends_[slice], to = ends_[slice + 1];
    const auto within = static_cast<float>(std::clamp((share - from) / (to - from), 0.0, 1.0));
    const AnglePlace at = angle_place(arc_cosine(azimuth_cosine), size_.azimuths);
    const double sine = std::sqrt(std::max(0.0, (1 - mu) * (1 + mu)));
    const double nu =
        std::clamp(mu * mu_sun_ + sine * static_cast<double>(azimuth_cosine) * sun_sine_, -1.0, 1.0);
    const Lanes rayleigh = splat(static_cast<float>(rayleigh_phase(nu))),
                mie = splat(static_cast<float>(mie_phase(air_.phase, air_.g, nu)));

    // Corners: the two rows, the two ends of the slice, the two azimuths.
    const std::size_t step = groups_ * kParts;
    const auto mix = [](Lanes a, Lanes b, float share_of_b) { return a + (b - a) * splat(share_of_b); };
    for (std::size_t g = 0; g < groups_; ++g) {
        Lanes depth[2], light[2];
        for (std::size_t r = 0; r < 2; ++r) {
            const std::size_t entry = (place.row + r) * (size_.slices + 1) + slice;
            depth[r] = mix(depth_[entry * groups_ + g], depth_[(entry + 1) * groups_ + g], within);
            Lanes parts[kParts];
            for (std::size_t part = 0; part < kParts; ++part) {
                const Lanes* const near =
                    &light_[(entry * size_.azimuths + at.column) * step + g * kParts + part];
                const Lanes* const far = near + size_.azimuths * step;
                parts[part] =
                    mix(mix(near[0], near[step], at.share), mix(far[0], far[step], at.share), within);
            }
            light[r] = parts[0] * rayleigh + parts[1] * mie + parts[2];
        }
        added[g] = mix(light[0], light[1], place.share);
        const Lanes through = mix(depth[0], depth[1], place.share);
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            transmittance[g][lane] = static_cast<float>(fast_exp(-static_cast<double>(through[lane])));
    }
}

} // namespace renderer
