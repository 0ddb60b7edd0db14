#include "renderer/sky/sky_light.h"

#include "renderer/math/transcendental.h"
#include "renderer/sampling/warp.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/optical_depth.h"
#include "renderer/sky/phase.h"
#include "renderer/sky/single_scattering.h"
#include "renderer/sky/sky_directions.h"
#include "renderer/sky/sky_rows.h"
#include "renderer/sky/sky_sun.h"
#include "renderer/sky/standing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace renderer {

namespace {

constexpr std::size_t kPointsBetween = 20;

} // namespace

SkyLight::SkyLight(const AtmosphereDescription& description, ThreadPool& pool, std::stop_token stop)
    : SkyLight(description, std::make_shared<const Sky>(description, pool, std::move(stop)), {}, 0, pool)
{
}

SkyLight::SkyLight(const AtmosphereDescription& description,
                   std::shared_ptr<const Sky> sky,
                   Vec3d eye,
                   double far_m,
                   ThreadPool& pool,
                   double most_table_error)
    : sky_(std::move(sky)), color_(sky_->air().wavelength_nm, description.sun.irradiance),
      origin_altitude_(description.altitude_m), sun_radius_(description.sun.angular_radius_deg * (kPi / 180)),
      limb_darkening_(description.sun.limb_darkening), to_sun_(direction_of_sun(description.sun))
{
    const Air& air = sky_->air();
    const Standing standing(air.radius_m, origin_altitude_, eye);
    up_ = standing.up;
    altitude_ = standing.altitude();
    mu_sun_ = std::clamp(dot(up_, to_sun_), -1.0, 1.0);
    // Its azimuth, also where it is in the zenith.
    const auto [east, north] = sin_cos_deg(description.sun.azimuth_deg);
    const Vec3d along{east, 0, -north}, across = to_sun_ - up_ * mu_sun_;
    sunwards_ = up_.y == 1                                  ? along
                : length(across) > 1e-9                     ? normalize(across)
                : length(along - up_ * dot(up_, along)) > 0 ? normalize(along - up_ * dot(up_, along))
                                                            : basis_around(up_).first;
    make_view(most_table_error, pool);
    if (!(far_m > 0)) return;
    // From beyond, a way begins where the air is thinnest and ends where it is thickest.
    AerialSize size;
    if (altitude_ > air.height_m) size.slices *= 3;
    aerial_.emplace(air, sky_->columns(), sky_->scattered(), altitude_, mu_sun_, far_m, pool, size);
}

void SkyLight::make_view(double most_error, ThreadPool& pool)
{
    SkyViewSize size;
    constexpr int kMostTimes = 3;
    for (int times = 0; times < kMostTimes; ++times) {
        view_.emplace(sky_->air(), sky_->columns(), sky_->scattered(), altitude_, mu_sun_, pool, size);
        table_error_ = error_of(*view_, pool);
        if (table_error_ <= most_error) return;
        size.rows *= 2;
        size.azimuths = 2 * size.azimuths - 1;
    }
}

double SkyLight::error_of(const SkyView& view, ThreadPool& pool) const
{
    constexpr std::size_t kDirections = 64;
    struct Pair {
        Spectrum exact{}, found{};
    };
    const Air& air = sky_->air();
    const SkyDirections directions(air, altitude_, mu_sun_, kDirections);
    std::vector<Pair> pairs(kDirections);
    pool.run(kDirections, [&](std::size_t i, unsigned) {
        const auto [geometry, cosine] = directions[i];
        const PlanetRay ray(air.radius_m, altitude_, geometry.mu);
        const SingleScattering once = single_scattering(air, ray, geometry, SkyPrecision::exact);
        if (const ScatteredLight* scattered = sky_->scattered())
            pairs[i].exact = scattered->radiance(scattered->path(ray), geometry.mu_sun, geometry.nu);
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            pairs[i].exact[w] += once.air[w] + once.ground[w];
        pairs[i].found = view.radiance(geometry.mu, cosine);
    });
    double worst = 0;
    for (std::size_t w = 0; w < air.wavelengths; ++w) {
        double sum = 0, sum2 = 0;
        for (const Pair& pair : pairs) {
            const double off = pair.found[w] - pair.exact[w];
            sum += pair.exact[w];
            sum2 += off * off;
        }
        if (sum > 0) worst = std::max(worst, std::sqrt(sum2 * kDirections) / sum);
    }
    return worst;
}

double SkyLight::azimuth_cosine(Vec3d direction, double mu) const
{
    const Vec3d across = direction - up_ * mu;
    const double size = length(across);
    return size > 0 ? std::clamp(dot(across, sunwards_) / size, -1.0, 1.0) : 1;
}

Rgb SkyLight::radiance(Vec3d direction) const
{
    const double mu = std::clamp(dot(direction, up_), -1.0, 1.0);
    std::array<Lanes, lane_groups(kMostWavelengths)> light;
    view_->radiance(mu, static_cast<float>(azimuth_cosine(direction, mu)), light.data());
    return color_.of_lanes(light.data());
}

SkyLight::Between SkyLight::air_before(Vec3d direction, double distance) const
{
    const double mu = std::clamp(dot(direction, up_), -1.0, 1.0);
    std::array<Lanes, lane_groups(kMostWavelengths)> through, added;
    aerial_->look(
        mu, static_cast<float>(azimuth_cosine(direction, mu)), distance, through.data(), added.data());
    return {color_.share_of_lanes(through.data()), color_.of_lanes(added.data())};
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
    return color_(sky_->transmittance(altitude_, std::clamp(dot(direction, up_), -1.0, 1.0))) *
           static_cast<float>(limb(sine2 / (edge * edge)) / disk);
}

Rgb SkyLight::sun_irradiance() const
{
    return color_(sky_->transmittance(altitude_, mu_sun_));
}

Rgb SkyLight::mean_sun_radiance() const
{
    // Rings of equal solid angle.
    constexpr std::size_t kRings = 8, kSpokes = 16;
    const auto [x, y] = basis_around(to_sun_);
    const double edge = sin_cos(sun_radius_).first;
    Rgb sum{};
    for (std::size_t i = 0; i < kRings; ++i)
        for (std::size_t k = 0; k < kSpokes; ++k) {
            const double off2 = edge * edge * (static_cast<double>(i) + 0.5) / kRings, off = std::sqrt(off2);
            const auto [s, c] = sin_cos_deg(360 * (static_cast<double>(k) + 0.5) / kSpokes);
            sum +=
                sun_radiance(normalize(to_sun_ * std::sqrt(std::max(0.0, 1 - off2)) + (x * c + y * s) * off));
        }
    return sum * (1.0f / (kRings * kSpokes));
}

SkyLight::Between SkyLight::between(Vec3d from, Vec3d to) const
{
    const Air& air = sky_->air();
    const Standing eye(air.radius_m, origin_altitude_, from), end(air.radius_m, origin_altitude_, to);
    const double distance = length(to - from);
    if (!(distance > 0)) return {};
    const Vec3d view = (to - from) / distance;
    const double mu = std::clamp(dot(eye.up, view), -1.0, 1.0),
                 mu_sun = std::clamp(dot(eye.up, to_sun_), -1.0, 1.0);
    const double nu = std::clamp(dot(view, to_sun_), -1.0, 1.0);
    const PlanetRay ray(air.radius_m, eye.altitude(), mu);
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
        const SunThroughAir light(air, sky_->columns(), altitude, std::clamp(sun, -1.0, 1.0));
        if (light.hidden()) continue;
        const Columns density = air.density(altitude), here = columns_along(air, ray, begin, u);
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            added[w] +=
                weight * air.transmittance(w, here) *
                static_cast<double>(light.transmittance(air, w / kLanes)[w % kLanes]) *
                (air.rayleigh[w] * density.rayleigh * rayleigh + air.mie_scattering[w] * density.mie * mie);
    }
    if (const ScatteredLight* scattered = sky_->scattered()) {
        // What all of the line of sight gathers, without what lies beyond.
        const double end_mu = std::clamp(dot(end.up, view), -1.0, 1.0);
        const Spectrum all = scattered->radiance(scattered->path(ray), mu_sun, nu);
        const Spectrum beyond =
            scattered->radiance(scattered->path(PlanetRay(air.radius_m, end.altitude(), end_mu)),
                                std::clamp(dot(end.up, to_sun_), -1.0, 1.0),
                                nu);
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            added[w] += std::max(0.0, all[w] - transmittance[w] * beyond[w]);
    }
    return {color_.share(transmittance), color_(added)};
}

SkyPanorama
SkyLight::panorama(std::size_t width, std::size_t height, ThreadPool& pool, std::size_t finer) const
{
    SkyPanorama picture{width, height, std::vector<Rgb>(width * height)};
    std::vector<double> easts(width), norths(width), cosines(width);
    for (std::size_t x = 0; x < width; ++x) {
        std::tie(easts[x], norths[x]) =
            sin_cos_deg(360 * ((static_cast<double>(x) + 0.5) / static_cast<double>(width) - 0.5));
        cosines[x] = std::clamp(easts[x] * sunwards_.x - norths[x] * sunwards_.z, -1.0, 1.0);
    }
    std::optional<SkyRows> rows;
    if (up_.y == 1) rows.emplace(*view_, color_, cosines); // a row has one angle to the vertical
    const auto fill_row = [&](double sine, double cosine, Rgb* pixels) {
        if (rows)
            rows->fill(sine, pixels);
        else
            for (std::size_t x = 0; x < width; ++x)
                pixels[x] = radiance({cosine * easts[x], sine, -cosine * norths[x]});
    };
    pool.run(height, [&](std::size_t y, unsigned) {
        Rgb* const pixels = &picture.pixels[y * width];
        std::vector<Rgb> part(finer > 1 ? width : 0);
        double weights = 0;
        for (std::size_t i = 0; i < finer; ++i) {
            const double place = static_cast<double>(y * finer + i) + 0.5;
            const auto [sine, cosine] = sin_cos_deg(90 - 180 * place / static_cast<double>(height * finer));
            if (finer == 1) return fill_row(sine, cosine, pixels);
            fill_row(sine, cosine, part.data());
            weights += cosine;
            for (std::size_t x = 0; x < width; ++x)
                pixels[x] += part[x] * static_cast<float>(cosine);
        }
        for (std::size_t x = 0; x < width; ++x)
            pixels[x] = pixels[x] / static_cast<float>(weights);
    });
    return picture;
}

} // namespace renderer
