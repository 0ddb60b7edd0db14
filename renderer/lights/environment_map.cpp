#include "renderer/lights/environment_map.h"

#include "renderer/color/strongest.h"
#include "renderer/math/transcendental.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace renderer {

namespace {

// Interval of a running sum that holds u, and where in it, in [0, 1).
template <typename T>
std::pair<std::size_t, double> find(const T* sums, std::size_t count, double u)
{
    const T* const end = sums + count + 1;
    const T* at = std::upper_bound(sums, end, static_cast<T>(u));
    std::size_t i = at == sums ? 0 : static_cast<std::size_t>(at - sums) - 1;
    i = std::min(i, count - 1);
    while (i > 0 && !(sums[i + 1] > sums[i])) // rounding may have led to one of no width
        --i;
    const double width = static_cast<double>(sums[i + 1]) - static_cast<double>(sums[i]);
    const double within = width > 0 ? (u - static_cast<double>(sums[i])) / width : 0.5;
    return {i, std::clamp(within, 0.0, 0x1.fffffffffffffp-1)};
}

} // namespace

EnvironmentMap::EnvironmentMap(std::uint32_t width,
                               std::uint32_t height,
                               std::vector<Rgb> texels,
                               double rotation_deg)
    : width_(width), height_(height), texels_(std::move(texels)), row_cosines_(height + 1), rows_(height + 1),
      columns_(std::size_t{height} * (std::size_t{width} + 1))
{
    std::tie(sin_turn_, cos_turn_) = sin_cos_deg(rotation_deg);
    for (std::uint32_t row = 0; row <= height; ++row)
        row_cosines_[row] = sin_cos_deg(180.0 * row / height).second;
    for (std::size_t row = 0; row < height; ++row) {
        float* const sums = &columns_[row * (width_ + 1)];
        double sum = 0;
        for (std::size_t x = 0; x < width; ++x)
            sum += static_cast<double>(strongest(texels_[row * width + x]));
        double running = 0;
        for (std::size_t x = 0; x < width; ++x) {
            sums[x] = static_cast<float>(sum > 0 ? running / sum : 0);
            running += static_cast<double>(strongest(texels_[row * width + x]));
        }
        sums[width] = sum > 0 ? 1.0f : 0.0f;
        rows_[row + 1] = rows_[row] + sum * solid_angle(row);
    }
    const double all = rows_[height];
    for (double& sum : rows_)
        sum = all > 0 ? sum / all : 0;
}

double EnvironmentMap::solid_angle(std::size_t row) const
{
    return 2 * kPi / width_ * (row_cosines_[row] - row_cosines_[row + 1]);
}

EnvironmentMap::Place EnvironmentMap::place_of(Vec3d direction) const
{
    // Turned back into the picture's own frame.
    const double x = direction.x * cos_turn_ - direction.z * sin_turn_,
                 z = direction.x * sin_turn_ + direction.z * cos_turn_;
    const double azimuth = atan2(x, -z);
    const double zenith = atan2(std::sqrt(x * x + z * z), direction.y);
    return {(0.5 + azimuth / (2 * kPi)) * width_, zenith / kPi * height_};
}

std::size_t EnvironmentMap::index_of(Vec3d direction) const
{
    const Place at = place_of(direction);
    const auto clamped = [](double x, std::uint32_t size) {
        return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(size - 1)));
    };
    return clamped(at.row, height_) * width_ + clamped(at.column, width_);
}

Rgb EnvironmentMap::radiance(Vec3d direction) const
{
    return texels_[index_of(direction)];
}

Rgb EnvironmentMap::interpolated(Vec3d direction) const
{
    const Place at = place_of(direction);
    const double x = at.column - 0.5, y = std::clamp(at.row - 0.5, 0.0, height_ - 1.0);
    const double left = std::floor(x), top = std::floor(y);
    const auto wrapped = [this](double column) {
        const auto w = static_cast<double>(width_);
        return static_cast<std::size_t>(column < 0 ? column + w : column >= w ? column - w : column);
    };
    const std::size_t x0 = wrapped(left), x1 = wrapped(left + 1), y0 = static_cast<std::size_t>(top),
                      y1 = std::min<std::size_t>(y0 + 1, height_ - 1);
    const auto fx = static_cast<float>(x - left), fy = static_cast<float>(y - top);
    const auto row = [&](std::size_t r) {
        return texels_[r * width_ + x0] * (1 - fx) + texels_[r * width_ + x1] * fx;
    };
    return row(y0) * (1 - fy) + row(y1) * fy;
}

EnvironmentMap::Sample EnvironmentMap::sample(Sample2 u) const
{
    if (!(rows_[height_] > 0)) return {};
    const auto [row, down] = find(rows_.data(), height_, static_cast<double>(u.u1));
    const auto [column, along] = find(&columns_[row * (width_ + 1)], width_, static_cast<double>(u.u0));
    const double cosine = row_cosines_[row] + (row_cosines_[row + 1] - row_cosines_[row]) * down;
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    const auto [s, c] = sin_cos_deg(((static_cast<double>(column) + along) / width_ - 0.5) * 360);
    const double x = sine * s, z = -sine * c;
    const Vec3d wi{x * cos_turn_ + z * sin_turn_, cosine, -x * sin_turn_ + z * cos_turn_};
    const float* const sums = &columns_[row * (width_ + 1) + column];
    const double chance =
        (rows_[row + 1] - rows_[row]) * (static_cast<double>(sums[1]) - static_cast<double>(sums[0]));
    if (!(chance > 0)) return {};
    return {normalize(wi), texels_[row * width_ + column], chance / solid_angle(row)};
}

double EnvironmentMap::pdf(Vec3d direction) const
{
    const std::size_t index = index_of(direction), row = index / width_, column = index % width_;
    const float* const sums = &columns_[row * (width_ + 1) + column];
    return (rows_[row + 1] - rows_[row]) * (static_cast<double>(sums[1]) - static_cast<double>(sums[0])) /
           solid_angle(row);
}

std::uint64_t EnvironmentMap::size_bytes() const
{
    return texels_.capacity() * sizeof(Rgb) + columns_.capacity() * sizeof(float) +
           (rows_.capacity() + row_cosines_.capacity()) * sizeof(double);
}

} // namespace renderer
