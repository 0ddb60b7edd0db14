#include "renderer/accel/split.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace renderer {

namespace {

constexpr std::size_t kFewItems = 32; // half the bins are enough for fewer

} // namespace

template <typename T>
Bins<T>::Bins(const RunBounds<T>& bounds, std::size_t count) : bins(count < kFewItems ? kMost / 2 : kMost)
{
    // Centres within [lower, upper] come into the bins 0 to bins - 1, and both of these get one.
    const Bounds3<T> centers = bounds.centers();
    Vec3<T> per_width{};
    for (unsigned axis = 0; axis < 3; ++axis) {
        const T s = static_cast<T>(bins) * (1 - 4 * std::numeric_limits<T>::epsilon()) /
                    (centers.upper[axis] - centers.lower[axis]);
        if (!std::isfinite(s) || !(s > 0)) continue; // no width to speak of, or too much of it
        per_width[axis] = s;
        usable |= 1u << axis;
    }
    alignas(16) const T first[4]{centers.lower.x, centers.lower.y, centers.lower.z, 0};
    alignas(16) const T widths[4]{per_width.x, per_width.y, per_width.z, 0};
    origin = Lanes4<T>::load(first);
    scale = Lanes4<T>::load(widths);
    const Box empty{Lanes4<T>::splat(std::numeric_limits<T>::infinity()),
                    Lanes4<T>::splat(-std::numeric_limits<T>::infinity())};
    for (std::size_t i = 0; i < bins; ++i) {
        std::fill(boxes[i], boxes[i] + 3, empty);
        std::fill(counts[i], counts[i] + 4, 0);
    }
}

template <typename T>
void Bins<T>::merge(const Bins& other)
{
    for (std::size_t i = 0; i < bins; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Box& box = boxes[i][axis];
            box.lower = min(other.boxes[i][axis].lower, box.lower);
            box.upper = max(other.boxes[i][axis].upper, box.upper);
            counts[i][axis] += other.counts[i][axis];
        }
}

template <typename T>
std::size_t Bins<T>::count_left(const Cut<T>& cut) const
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(cut.below); ++i)
        count += static_cast<std::size_t>(counts[i][cut.axis]);
    return count;
}

template <typename T>
std::optional<Cut<T>> cut_at_midpoint(const RunBounds<T>& bounds)
{
    const Bounds3<T> centers = bounds.centers();
    const unsigned axis = longest_axis(centers);
    const T middle = centers.center()[axis];
    if (!(centers.lower[axis] < middle && middle <= centers.upper[axis])) return std::nullopt;
    return Cut<T>{Lanes4<T>::splat(0), Lanes4<T>::splat(1), middle, axis};
}

template <typename T>
Sides<T> split_at_median(std::span<BuildItem<T>> run, const RunBounds<T>& bounds)
{
    const unsigned axis = longest_axis(bounds.centers());
    const auto center = [axis](const BuildItem<T>& item) {
        return item.lower[axis] * T(0.5) + item.upper[axis] * T(0.5);
    };
    Sides<T> sides{run.size() / 2, {}};
    const auto middle = run.begin() + static_cast<std::ptrdiff_t>(sides.left);
    std::nth_element(run.begin(), middle, run.end(), [&](const BuildItem<T>& a, const BuildItem<T>& b) {
        const T ca = center(a), cb = center(b);
        return ca != cb ? ca < cb : a.primitive < b.primitive;
    });
    for (std::size_t i = 0; i < run.size(); ++i)
        sides.bounds[i < sides.left ? 0 : 1].extend(run[i]);
    return sides;
}

template struct Bins<float>;
template struct Bins<double>;
template std::optional<Cut<float>> cut_at_midpoint(const RunBounds<float>&);
template std::optional<Cut<double>> cut_at_midpoint(const RunBounds<double>&);
template Sides<float> split_at_median(std::span<BuildItem<float>>, const RunBounds<float>&);
template Sides<double> split_at_median(std::span<BuildItem<double>>, const RunBounds<double>&);

} // namespace renderer
