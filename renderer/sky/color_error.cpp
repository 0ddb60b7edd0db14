#include "renderer/sky/color_error.h"

#include "renderer/sky/optical_depth.h"
#include "renderer/sky/single_scattering.h"
#include "renderer/sky/sky_color.h"
#include "renderer/sky/sky_directions.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace renderer {

namespace {

constexpr std::size_t kDirections = 24;

bool follows_laws(const AtmosphereDescription& a)
{
    const auto is_law = [](const std::vector<double>& list) { return list.size() <= 1; };
    return is_law(a.planet.ground_albedo) && is_law(a.rayleigh.scattering) && is_law(a.mie.scattering) &&
           is_law(a.mie.extinction) && is_law(a.ozone.absorption);
}

std::vector<double> dense_wavelengths()
{
    std::vector<double> nm;
    for (std::size_t i = 0; i < kDenseWavelengths; ++i)
        nm.push_back(385 + 10 * static_cast<double>(i));
    return nm;
}

// An air, and what colour its light has under a white sun.
struct Seen {
    Air air;
    SkyColor color;

    explicit Seen(const AtmosphereDescription& a) : air(make_air(a)), color(a.wavelengths_nm, {1, 1, 1}) {}

    [[nodiscard]] Rgb sky(const SkyGeometry& geometry) const
    {
        const SingleScattering once = single_scattering(air, geometry, SkyPrecision::quick);
        Spectrum sum{};
        for (std::size_t w = 0; w < air.wavelengths; ++w)
            sum[w] = once.air[w] + once.ground[w];
        return color(sum);
    }
    [[nodiscard]] Rgb sun(double altitude, double mu_sun) const
    {
        const WayOut out = columns_to_top(air, altitude, mu_sun);
        Spectrum through{};
        for (std::size_t w = 0; w < air.wavelengths && !out.blocked; ++w)
            through[w] = air.transmittance(w, out.columns);
        return color(through);
    }
};

class Difference {
public:
    void add(Rgb told, Rgb true_color)
    {
        for (const auto& [a, b] : {std::pair{told.r, true_color.r},
                                   std::pair{told.g, true_color.g},
                                   std::pair{told.b, true_color.b}}) {
            sum_ += static_cast<double>(b);
            sum2_ += static_cast<double>(a - b) * static_cast<double>(a - b);
            ++count_;
        }
    }
    [[nodiscard]] bool is_black() const { return !(sum_ > 0); }
    [[nodiscard]] double relative() const { return is_black() ? 0 : std::sqrt(sum2_ * count_) / sum_; }

private:
    double sum_ = 0, sum2_ = 0, count_ = 0;
};

} // namespace

std::optional<ColorError>
color_error(const AtmosphereDescription& description, double altitude_m, double mu_sun)
{
    if (!follows_laws(description)) return std::nullopt;
    AtmosphereDescription dense = description;
    dense.wavelengths_nm = dense_wavelengths();
    const Seen told(description), truth(dense);
    const SkyDirections directions(told.air, altitude_m, mu_sun, kDirections);
    Difference sky, sun;
    for (std::size_t i = 0; i < kDirections; ++i) {
        const SkyGeometry geometry = directions[i].geometry;
        sky.add(told.sky(geometry), truth.sky(geometry));
    }
    sun.add(told.sun(altitude_m, mu_sun), truth.sun(altitude_m, mu_sun));
    if (sky.is_black()) return std::nullopt;
    return ColorError{sky.relative(), sun.relative()};
}

} // namespace renderer
