#include "renderer/accel/split.h"

#include "renderer/accel/float4.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace renderer {

namespace {

constexpr std::size_t kBins = 16;
constexpr std::size_t kFewItems = 32; // half the bins are enough for fewer

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

// Boxes grown item by item: in four lanes at once where T is float.
template <typename T>
struct GrowingBox {
    Bounds3<T> box;

    void extend(const BuildItem<T>& item) { box.extend(Bounds3<T>{item.lower, item.upper}); }
    void extend(const GrowingBox& other) { box.extend(other.box); }
    void extend_by_center(const BuildItem<T>& item)
    {
        box.extend(Vec3<T>{item.center(0), item.center(1), item.center(2)});
    }
    Bounds3<T> get() const { return box; }
};

template <>
struct GrowingBox<float> {
    Float4 lower = Float4::splat(std::numeric_limits<float>::infinity());
    Float4 upper = Float4::splat(-std::numeric_limits<float>::infinity());

    void extend(const BuildItem<float>& item)
    {
        lower = min(Float4::load3(item.lower), lower);
        upper = max(Float4::load3(item.upper), upper);
    }
    void extend(const GrowingBox& other)
    {
        lower = min(other.lower, lower);
        upper = max(other.upper, upper);
    }
    void extend_by_center(const BuildItem<float>& item)
    {
        const Float4 half = Float4::splat(0.5f);
        const Float4 center = Float4::load3(item.lower) * half + Float4::load3(item.upper) * half;
        lower = min(center, lower);
        upper = max(center, upper);
    }
    Bounds3f get() const
    {
        alignas(16) float l[4], u[4];
        lower.store(l);
        upper.store(u);
        return {{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
    }
};

// Maps centres to bins along each axis; scale 0 where the centres coincide (or all but): every item in bin 0.
template <typename T>
struct Binning {
    Vec3<T> lower, scale;
    std::size_t bins;

    Binning(const Bounds3<T>& centers, std::size_t count) : lower(centers.lower), bins(count)
    {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const T s = static_cast<T>(bins) * (1 - 4 * std::numeric_limits<T>::epsilon()) /
                        (centers.upper[axis] - centers.lower[axis]);
            scale[axis] = std::isfinite(s) && s > 0 ? s : 0;
        }
    }
    bool usable(std::size_t axis) const { return scale[axis] > 0; }
    std::int32_t bin(const BuildItem<T>& item, std::size_t axis) const
    {
        const auto place = static_cast<std::int32_t>((item.center(axis) - lower[axis]) * scale[axis]);
        return std::clamp(place, 0, static_cast<std::int32_t>(bins) - 1);
    }
};

template <typename T>
struct Bins {
    struct Bin {
        GrowingBox<T> box;
        std::uint32_t count = 0;
    };
    std::array<std::array<Bin, kBins>, 3> axes;

    Bins(std::span<const BuildItem<T>> run, const Binning<T>& map)
    {
        for (const BuildItem<T>& item : run)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                Bin& bin = axes[axis][static_cast<std::size_t>(map.bin(item, axis))];
                bin.box.extend(item);
                ++bin.count;
            }
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
        const std::uint32_t blocks = (count + block - 1) / block;
        return measure(box, inverse_extent) * blocks / whole;
    }
};

template <typename T>
void try_planes(
    const Bins<T>& bins, std::size_t axis, std::size_t count_of_bins, const CostModel& model, Plane& best)
{
    const auto& line = bins.axes[axis];
    std::array<double, kBins> right_cost{};
    GrowingBox<T> box;
    std::uint32_t count = 0;
    double cost = -1; // nothing on this side yet
    for (std::size_t i = count_of_bins; i-- > 1;) {
        if (line[i].count != 0) {
            box.extend(line[i].box);
            count += line[i].count;
            cost = model.side(box.get(), count);
        }
        right_cost[i] = cost;
    }
    box = {};
    count = 0;
    for (std::size_t i = 1; i < count_of_bins; ++i) {
        if (line[i - 1].count == 0)
            continue; // the plane before does the same, or there is nothing on the left
        box.extend(line[i - 1].box);
        count += line[i - 1].count;
        if (right_cost[i] < 0) break;
        const double both = model.side(box.get(), count) + right_cost[i];
        if (both < best.cost) best = {axis, i, both};
    }
}

} // namespace

template <typename T>
RunBounds<T> bounds_of(std::span<const BuildItem<T>> run)
{
    GrowingBox<T> box, centers;
    for (const BuildItem<T>& item : run) {
        box.extend(item);
        centers.extend_by_center(item);
    }
    return {box.get(), centers.get()};
}

template <typename T>
std::optional<SplitChoice>
split_by_sah(std::span<BuildItem<T>> run, const RunBounds<T>& bounds, std::uint32_t block, double limit)
{
    const std::size_t longest = longest_axis(bounds.box);
    const double half = static_cast<double>(bounds.box.upper[longest]) * 0.5 -
                        static_cast<double>(bounds.box.lower[longest]) * 0.5;
    if (!(half > 0)) return std::nullopt;
    const double inverse_extent = 0.5 / half;
    const CostModel model{inverse_extent, measure(bounds.box, inverse_extent), block};
    const Binning<T> map(bounds.centers, run.size() < kFewItems ? kBins / 2 : kBins);
    const Bins<T> bins(run, map);
    Plane best;
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (map.usable(axis)) try_planes(bins, axis, map.bins, model, best);
    if (!std::isfinite(best.cost)) return std::nullopt;
    if (best.cost >= limit) return SplitChoice{0, best.cost};
    const auto middle = std::partition(run.begin(), run.end(), [&](const BuildItem<T>& item) {
        return map.bin(item, best.axis) < static_cast<std::int32_t>(best.bin);
    });
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
