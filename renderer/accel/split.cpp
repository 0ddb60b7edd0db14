#include "renderer/accel/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace renderer {

namespace {

constexpr std::size_t kBins = 16;

template <typename T>
std::size_t longest_axis(const Bounds3<T>& box)
{
    // Halves, so that the extent of the whole range of T stays finite.
    const Vec3<T> half = box.upper * T(0.5) - box.lower * T(0.5);
    return half.x >= half.y ? (half.x >= half.z ? 0u : 2u) : (half.y >= half.z ? 1u : 2u);
}

// Half the area of a box in units of the run's largest extent squared, so that nothing over- or underflows. A
// trace of its edges is added: without it boxes on a line would all cost nothing.
template <typename T>
double measure(const Bounds3<T>& box, double inverse_extent)
{
    const auto side = [&](T upper, T lower) {
        return (static_cast<double>(upper) * inverse_extent) - (static_cast<double>(lower) * inverse_extent);
    };
    const double x = side(box.upper.x, box.lower.x), y = side(box.upper.y, box.lower.y),
                 z = side(box.upper.z, box.lower.z);
    return x * y + y * z + z * x + 1e-4 * (x + y + z);
}

template <typename T>
struct Bin {
    Bounds3<T> box;
    std::uint32_t count = 0;
};

// Maps centres to bins along one axis; not usable where the centres coincide (or all but).
template <typename T>
struct Binning {
    std::size_t axis;
    T lower;
    T scale;
    bool usable;

    Binning(const Bounds3<T>& centers, std::size_t split_axis)
        : axis(split_axis), lower(centers.lower[split_axis])
    {
        scale = T(kBins) * (1 - 4 * std::numeric_limits<T>::epsilon()) / (centers.upper[axis] - lower);
        usable = centers.upper[axis] > lower && std::isfinite(scale) && scale > 0;
    }
    std::size_t operator()(const BuildItem<T>& item) const
    {
        const auto bin = static_cast<std::int32_t>((item.center(axis) - lower) * scale);
        return static_cast<std::size_t>(std::clamp(bin, 0, static_cast<std::int32_t>(kBins) - 1));
    }
};

struct Plane {
    std::size_t axis = 0, bin = 0; // bins below `bin` go left
    double cost = std::numeric_limits<double>::infinity();
};

// What a side costs: its measure times the tests of its primitives.
struct CostModel {
    double inverse_extent; // unit of measure()
    double whole;          // measure of the run's box
    std::uint32_t block;   // primitives tested at once

    template <typename T>
    double side(const Bounds3<T>& box, std::uint32_t count) const
    {
        return measure(box, inverse_extent) * ((count + block - 1) / block) / whole;
    }
};

template <typename T>
void try_planes(const std::array<Bin<T>, kBins>& bins, std::size_t axis, const CostModel& model, Plane& best)
{
    std::array<double, kBins> right_cost{};
    Bounds3<T> box;
    std::uint32_t count = 0;
    for (std::size_t i = kBins; i-- > 1;) {
        if (bins[i].count != 0) box.extend(bins[i].box);
        count += bins[i].count;
        right_cost[i] = count == 0 ? -1 : model.side(box, count);
    }
    box = {};
    count = 0;
    for (std::size_t i = 1; i < kBins; ++i) {
        if (bins[i - 1].count != 0) box.extend(bins[i - 1].box);
        count += bins[i - 1].count;
        if (count == 0 || right_cost[i] < 0) continue;
        const double cost = model.side(box, count) + right_cost[i];
        if (cost < best.cost) best = {axis, i, cost};
    }
}

} // namespace

template <typename T>
RunBounds<T> bounds_of(std::span<const BuildItem<T>> run)
{
    RunBounds<T> bounds;
    for (const BuildItem<T>& item : run) {
        bounds.box.extend(Bounds3<T>{item.lower, item.upper});
        bounds.centers.extend(Vec3<T>{item.center(0), item.center(1), item.center(2)});
    }
    return bounds;
}

template <typename T>
std::optional<SplitChoice>
split_by_sah(std::span<BuildItem<T>> run, const RunBounds<T>& bounds, std::uint32_t block, double limit)
{
    const std::array<Binning<T>, 3> binning{
        Binning<T>(bounds.centers, 0), Binning<T>(bounds.centers, 1), Binning<T>(bounds.centers, 2)};
    std::array<std::array<Bin<T>, kBins>, 3> bins;
    for (const BuildItem<T>& item : run)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!binning[axis].usable) continue;
            Bin<T>& bin = bins[axis][binning[axis](item)];
            bin.box.extend(Bounds3<T>{item.lower, item.upper});
            ++bin.count;
        }
    const std::size_t longest = longest_axis(bounds.box);
    const double half = static_cast<double>(bounds.box.upper[longest]) * 0.5 -
                        static_cast<double>(bounds.box.lower[longest]) * 0.5;
    if (!(half > 0)) return std::nullopt;
    const double inverse_extent = 0.5 / half;
    const CostModel model{inverse_extent, measure(bounds.box, inverse_extent), block};
    Plane best;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (binning[axis].usable) try_planes(bins[axis], axis, model, best);
    if (!std::isfinite(best.cost)) return std::nullopt;
    if (best.cost >= limit) return SplitChoice{0, best.cost};
    const Binning<T>& map = binning[best.axis];
    const auto middle = std::partition(
        run.begin(), run.end(), [&](const BuildItem<T>& item) { return map(item) < best.bin; });
    return SplitChoice{static_cast<std::size_t>(middle - run.begin()), best.cost};
}

template <typename T>
std::optional<std::size_t> split_at_midpoint(std::span<BuildItem<T>> run, const RunBounds<T>& bounds)
{
    const std::size_t axis = longest_axis(bounds.centers);
    const T middle_plane = bounds.centers.center()[axis];
    const auto middle = std::partition(
        run.begin(), run.end(), [&](const BuildItem<T>& item) { return item.center(axis) < middle_plane; });
    if (middle == run.begin() || middle == run.end()) return std::nullopt;
    return static_cast<std::size_t>(middle - run.begin());
}

template <typename T>
std::size_t split_at_median(std::span<BuildItem<T>> run, const RunBounds<T>& bounds)
{
    const std::size_t axis = longest_axis(bounds.centers);
    const auto middle = run.begin() + static_cast<std::ptrdiff_t>(run.size() / 2);
    std::nth_element(run.begin(), middle, run.end(), [&](const BuildItem<T>& a, const BuildItem<T>& b) {
        const T ca = a.center(axis), cb = b.center(axis);
        return ca != cb ? ca < cb : a.primitive < b.primitive;
    });
    return run.size() / 2;
}

template RunBounds<float> bounds_of(std::span<const BuildItem<float>>);
template RunBounds<double> bounds_of(std::span<const BuildItem<double>>);
template std::optional<SplitChoice>
split_by_sah(std::span<BuildItem<float>>, const RunBounds<float>&, std::uint32_t, double);
template std::optional<SplitChoice>
split_by_sah(std::span<BuildItem<double>>, const RunBounds<double>&, std::uint32_t, double);
template std::optional<std::size_t> split_at_midpoint(std::span<BuildItem<float>>, const RunBounds<float>&);
template std::optional<std::size_t> split_at_midpoint(std::span<BuildItem<double>>, const RunBounds<double>&);
template std::size_t split_at_median(std::span<BuildItem<float>>, const RunBounds<float>&);
template std::size_t split_at_median(std::span<BuildItem<double>>, const RunBounds<double>&);

} // namespace renderer
