#include "renderer/sky/column_table.h"

#include "renderer/sky/optical_depth.h"
#include "renderer/sky/planet_ray.h"
#include "renderer/sky/tent_column.h"

#include <algorithm>
#include <cmath>

namespace renderer {

namespace {

// From altitude to the top along the ray whose cosine is mu: stable near the ground and near the top.
double distance_to_top(double radius, double height, double altitude, double mu)
{
    const double r = radius + altitude, gap = (height - altitude) * (2 * radius + height + altitude);
    const double along = r * mu, root = std::sqrt(std::max(0.0, along * along + gap));
    return along > 0 ? gap / (along + root) : root - along;
}

double cosine_at(double radius, double height, double altitude, double distance)
{
    if (distance <= 0) return 1;
    const double r = radius + altitude, gap = (height - altitude) * (2 * radius + height + altitude);
    return std::clamp((gap - distance * distance) / (2 * r * distance), -1.0, 1.0);
}

double horizon_distance(double radius, double height, double altitude)
{
    return std::sqrt(altitude * (2 * radius + altitude)) + std::sqrt(height * (2 * radius + height));
}

// The cubic through four neighbours.
struct Stencil {
    std::size_t first = 0;
    double weight[4]{};

    Stencil(double at, std::size_t count)
        : first(std::clamp(static_cast<std::size_t>(at), std::size_t(1), count - 3) - 1)
    {
        const double a = at - static_cast<double>(first), b = a - 1, c = a - 2, d = a - 3;
        weight[0] = -b * c * d / 6;
        weight[1] = a * c * d / 2;
        weight[2] = -a * b * d / 2;
        weight[3] = a * b * c / 6;
    }
};

} // namespace

ColumnTable::ColumnTable(const Air& air, ThreadPool& pool)
    : radius_(air.radius_m), height_(air.height_m), ozone_center_(air.ozone_center_m),
      ozone_half_width_(air.ozone_half_width_m),
      has_ozone_(std::any_of(air.ozone.begin(), air.ozone.end(), [](double a) { return a > 0; })),
      columns_(kRows * kPlaces)
{
    pool.run(kRows, [&](std::size_t row, unsigned) {
        const double share = static_cast<double>(row) / (kRows - 1), altitude = height_ * share * share;
        const double nearest = height_ - altitude, farthest = horizon_distance(radius_, height_, altitude);
        for (std::size_t place = 0; place < kPlaces; ++place) {
            const double x = static_cast<double>(place) / (kPlaces - 1);
            const double mu =
                cosine_at(radius_, height_, altitude, nearest + (farthest - nearest) * x * (2 - x));
            const Columns columns = columns_past_ground(air, altitude, mu);
            columns_[row * kPlaces + place] = {columns.rayleigh, columns.mie};
        }
    });
}

Columns ColumnTable::at(double altitude, double mu) const
{
    if (altitude >= height_) return {};
    const double nearest = height_ - altitude, farthest = horizon_distance(radius_, height_, altitude);
    const double distance = distance_to_top(radius_, height_, altitude, mu);
    const double share = std::clamp((distance - nearest) / (farthest - nearest), 0.0, 1.0);
    // x (2 - x) = share.
    const Stencil across(share / (1 + std::sqrt(1 - share)) * (kPlaces - 1), kPlaces);
    const Stencil up(std::sqrt(std::max(0.0, altitude) / height_) * (kRows - 1), kRows);
    Columns sum;
    for (std::size_t i = 0; i < 4; ++i) {
        const Entry* row = &columns_[(up.first + i) * kPlaces + across.first];
        Entry along;
        for (std::size_t j = 0; j < 4; ++j) {
            along.rayleigh += row[j].rayleigh * across.weight[j];
            along.mie += row[j].mie * across.weight[j];
        }
        sum.rayleigh += along.rayleigh * up.weight[i];
        sum.mie += along.mie * up.weight[i];
    }
    if (has_ozone_) sum.ozone = ozone_at(std::max(0.0, altitude), mu);
    return sum;
}

double ColumnTable::ozone_at(double altitude, double mu) const
{
    PlanetRay ray(radius_, altitude, mu);
    if (ray.hits_ground()) ray = PlanetRay::through(radius_, altitude, 0, true);
    return tent_column(ozone_center_, ozone_half_width_, radius_, ray, ray.start(), ray.distance_at(height_));
}

} // namespace renderer
