#include "renderer/sky/scatter_kernel.h"

#include "renderer/math/transcendental.h"
#include "renderer/sky/gauss_legendre.h"
#include "renderer/sky/phase.h"

#include <algorithm>
#include <cmath>

namespace renderer {

Directions directions_at(const Air& air, const GridResolution& resolution, double altitude)
{
    Directions directions;
    const double r = air.radius_m + altitude;
    const double horizon = -std::sqrt(altitude * (2 * air.radius_m + altitude)) / r;
    const auto add = [&](std::size_t points, double range) {
        const GaussLegendre rule(points);
        for (std::size_t i = 0; i < points; ++i) {
            const double t = rule.x[i], mu = std::clamp(horizon + range * t * t, -1.0, 1.0);
            directions.mu.push_back(mu);
            directions.sine.push_back(std::sqrt((1 - mu) * (1 + mu)));
            directions.weight.push_back(std::abs(range) * 2 * t * rule.weight[i]);
        }
    };
    add(resolution.sky, 1 - horizon);
    add(resolution.down, -1 - horizon);
    const std::size_t last = resolution.azimuths - 1;
    for (std::size_t p = 0; p <= last; ++p) {
        directions.azimuth_cosine.push_back(
            sin_cos_deg(180 * static_cast<double>(p) / static_cast<double>(last)).second);
        directions.azimuth_weight.push_back((p == 0 || p == last ? 1 : 2) * kPi / static_cast<double>(last));
    }
    return directions;
}

ScatterKernel::ScatterKernel(const Air& air, const GridResolution& resolution, const Directions& directions)
    : angles_(directions.mu.size()), azimuths_(resolution.azimuths), out_(resolution.out_angles),
      directions_(directions), kernel_(azimuths_ * out_ * angles_), to_order_(azimuths_ * azimuths_),
      from_order_(out_ * azimuths_)
{
    const std::size_t last = azimuths_ - 1;
    const auto cosine = [](std::size_t product, std::size_t half_turn) {
        return sin_cos_deg(180 * static_cast<double>(product % (2 * half_turn)) /
                           static_cast<double>(half_turn))
            .second;
    };
    for (std::size_t m = 0; m < azimuths_; ++m) {
        for (std::size_t p = 0; p < azimuths_; ++p)
            to_order_[m * azimuths_ + p] =
                static_cast<float>(cosine(m * p, last) * directions.azimuth_weight[p]);
        for (std::size_t a = 0; a < out_; ++a)
            from_order_[a * azimuths_ + m] =
                static_cast<float>((m == 0 || m == last ? 1 : 2) * cosine(m * a, out_ - 1));
    }
    // Orders of the phase function between each pair of zenith angles, by the trapezoid rule, four times as fine as the
    // highest of them asks; then scaled so that no direction gains or loses light.
    const std::size_t steps = 4 * last;
    std::vector<double> phase(steps + 1), row(azimuths_ * angles_);
    for (std::size_t t = 0; t < out_; ++t) {
        const auto [sine, mu] = sin_cos_deg(180 * static_cast<double>(t) / static_cast<double>(out_ - 1));
        double sum = 0;
        for (std::size_t j = 0; j < angles_; ++j) {
            for (std::size_t s = 0; s <= steps; ++s) {
                const double nu = mu * directions.mu[j] + sine * directions.sine[j] * cosine(s, steps);
                phase[s] = mie_phase(air.phase, air.g, std::clamp(nu, -1.0, 1.0)) *
                           (s == 0 || s == steps ? 0.5 : 1) / static_cast<double>(steps);
            }
            for (std::size_t m = 0; m < azimuths_; ++m) {
                double order = 0;
                for (std::size_t s = 0; s <= steps; ++s)
                    order += phase[s] * cosine(m * s, steps);
                row[m * angles_ + j] = order * directions.weight[j];
            }
            sum += row[j];
        }
        for (std::size_t m = 0; m < azimuths_; ++m)
            for (std::size_t j = 0; j < angles_; ++j)
                kernel_[(m * out_ + t) * angles_ + j] =
                    static_cast<float>(row[m * angles_ + j] / (2 * kPi * sum));
    }
}

Moments ScatterKernel::moments(const Lanes* light) const
{
    Moments sum;
    for (std::size_t j = 0; j < angles_; ++j) {
        Lanes all{}, along{}, squared{};
        for (std::size_t p = 0; p < azimuths_; ++p) {
            const double c = directions_.azimuth_cosine[p], w = directions_.azimuth_weight[p];
            const Lanes value = light[j * azimuths_ + p];
            all += value * splat(static_cast<float>(w));
            along += value * splat(static_cast<float>(w * c));
            squared += value * splat(static_cast<float>(w * c * c));
        }
        const double mu = directions_.mu[j], sine = directions_.sine[j], w = directions_.weight[j];
        sum.xx += squared * splat(static_cast<float>(w * sine * sine));
        sum.yy += (all - squared) * splat(static_cast<float>(w * sine * sine));
        sum.zz += all * splat(static_cast<float>(w * mu * mu));
        sum.xz += along * splat(static_cast<float>(w * mu * sine));
    }
    const Lanes scale = splat(static_cast<float>(3 / (16 * kPi)));
    return {sum.xx * scale, sum.yy * scale, sum.zz * scale, sum.xz * scale};
}

void ScatterKernel::scatter(const Lanes* light, Lanes* out, std::vector<Lanes>& scratch) const
{
    scratch.resize(angles_ + out_ * azimuths_);
    Lanes* of_order = scratch.data();
    Lanes* leaving = of_order + angles_; // [out zenith][order]
    for (std::size_t m = 0; m < azimuths_; ++m) {
        for (std::size_t j = 0; j < angles_; ++j) {
            Lanes sum{};
            for (std::size_t p = 0; p < azimuths_; ++p)
                sum += light[j * azimuths_ + p] * splat(to_order_[m * azimuths_ + p]);
            of_order[j] = sum;
        }
        for (std::size_t t = 0; t < out_; ++t) {
            const float* weights = &kernel_[(m * out_ + t) * angles_];
            Lanes sum{};
            for (std::size_t j = 0; j < angles_; ++j)
                sum += of_order[j] * splat(weights[j]);
            leaving[t * azimuths_ + m] = sum;
        }
    }
    for (std::size_t t = 0; t < out_; ++t)
        for (std::size_t a = 0; a < out_; ++a) {
            Lanes sum{};
            for (std::size_t m = 0; m < azimuths_; ++m)
                sum += leaving[t * azimuths_ + m] * splat(from_order_[a * azimuths_ + m]);
            out[t * out_ + a] = sum;
        }
}

} // namespace renderer
