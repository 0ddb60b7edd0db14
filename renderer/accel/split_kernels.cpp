#include "renderer/accel/split.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

// This file is compiled twice: for AVX2, and for what every processor has. What is above, once.
// clang-format off
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/accel/split_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace renderer::HWY_NAMESPACE {
namespace {

// Half the area of three boxes, one a lane, in units of the run's largest extent squared, so that nothing over- or
// underflows. A trace of its edges is added: without it boxes on a line would all cost nothing.
template <typename T>
struct Measure {
    Lanes4<T> inverse_half; // of the largest extent

    Lanes4<T> of(const Lanes4<T> (&lower)[3], const Lanes4<T> (&upper)[3]) const
    {
        const Lanes4<T> half = Lanes4<T>::splat(T(0.5));
        const auto extent = [&](std::size_t i) { return (upper[i] * half - lower[i] * half) * inverse_half; };
        Lanes4<T> x = extent(0), y = extent(1), z = extent(2), none = Lanes4<T>::splat(0);
        transpose(x, y, z, none);
        return x * (y + z) + y * z + Lanes4<T>::splat(T(1e-4)) * (x + y + z);
    }
};

// Where an item is, as a cut sees it.
template <typename T>
struct Placed {
    Lanes4<T> lower, upper, center, place;

    Placed(const BuildItem<T>& item, Lanes4<T> origin, Lanes4<T> scale)
        : lower(Lanes4<T>::load3(item.lower)), upper(Lanes4<T>::load3(item.upper)),
          center(RunBounds<T>::center_of(lower, upper)), place((center - origin) * scale)
    {
    }
};

// 0: left, 1: right.
template <typename T>
unsigned side_of(const Placed<T>& item, const Cut<T>& cut)
{
    return (~less(item.place, Lanes4<T>::splat(cut.below)) >> cut.axis) & 1;
}

template <typename T>
void add(Bins<T>& bins, std::span<const BuildItem<T>> run)
{
    const Lanes4<T> zero = Lanes4<T>::splat(0), last = Lanes4<T>::splat(static_cast<T>(bins.bins - 1));
    alignas(16) std::int32_t bin[4];
    for (const BuildItem<T>& item : run) {
        const Placed<T> at(item, bins.origin, bins.scale);
        // Where an axis cannot be used its place may be a NaN: that becomes 0.
        min(max(at.place, zero), last).store_truncated(bin);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            auto& box = bins.boxes[bin[axis]][axis];
            box.lower = min(at.lower, box.lower);
            box.upper = max(at.upper, box.upper);
            ++bins.counts[bin[axis]][axis];
        }
    }
}

template <typename T>
std::optional<Cut<T>>
best_cut(const Bins<T>& bins, const RunBounds<T>& bounds, std::uint32_t block, double limit)
{
    const Bounds3<T> whole = bounds.box();
    const unsigned longest = longest_axis(whole);
    const T half = whole.upper[longest] * T(0.5) - whole.lower[longest] * T(0.5);
    const T inverse_half = 1 / half;
    if (bins.usable == 0 || !std::isfinite(inverse_half)) return std::nullopt;
    const Measure<T> measure{Lanes4<T>::splat(inverse_half)};

    // What one side costs, axes in lanes: its measure times the tests of its primitives.
    Lanes4<T> lower[3], upper[3];
    alignas(16) std::int32_t count[4];
    const int per_block = std::countr_zero(block); // a shift: divisions here took a tenth of the build
    const auto start = [&] {
        std::fill(lower, lower + 3, Lanes4<T>::splat(std::numeric_limits<T>::infinity()));
        std::fill(upper, upper + 3, Lanes4<T>::splat(-std::numeric_limits<T>::infinity()));
        std::fill(count, count + 4, 0);
    };
    const auto with = [&](std::size_t bin) {
        alignas(16) std::int32_t blocks[4]{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = min(bins.boxes[bin][axis].lower, lower[axis]);
            upper[axis] = max(bins.boxes[bin][axis].upper, upper[axis]);
            count[axis] += bins.counts[bin][axis];
            blocks[axis] = (count[axis] + static_cast<std::int32_t>(block) - 1) >> per_block;
        }
        return measure.of(lower, upper) * Lanes4<T>::from_integers(blocks);
    };
    // Both end bins of a usable axis have items, so no side of any plane is empty.
    Lanes4<T> right[Bins<T>::kMost];
    start();
    for (std::size_t i = bins.bins; i-- > 1;)
        right[i] = with(i);
    start();
    alignas(16) T cost[Bins<T>::kMost][4];
    for (std::size_t i = 1; i < bins.bins; ++i)
        (with(i - 1) + right[i]).store(cost[i]);

    Lanes4<T> box_lower[3]{bounds.lower, bounds.lower, bounds.lower},
        box_upper[3]{bounds.upper, bounds.upper, bounds.upper};
    alignas(16) T whole_measure[4];
    measure.of(box_lower, box_upper).store(whole_measure);
    const T most =
        std::isfinite(limit) ? static_cast<T>(limit) * whole_measure[0] : std::numeric_limits<T>::infinity();
    T least = most;
    Cut<T> best{bins.origin, bins.scale};
    for (unsigned axis = 0; axis < 3; ++axis) {
        if ((bins.usable >> axis & 1) == 0) continue;
        for (std::size_t i = 1; i < bins.bins; ++i) {
            if (!(cost[i][axis] < least)) continue;
            least = cost[i][axis];
            best.axis = axis;
            best.below = static_cast<T>(i);
        }
    }
    if (!(least < most)) return std::nullopt;
    return best;
}

template <typename T>
Sides<T> partition(std::span<BuildItem<T>> run, const Cut<T>& cut)
{
    // Without a branch that nobody could foresee.
    Sides<T> sides;
    BuildItem<T>* next_left = run.data();
    for (BuildItem<T>& here : run) {
        const BuildItem<T> item = here;
        const Placed<T> at(item, cut.origin, cut.scale);
        const unsigned side = side_of(at, cut);
        sides.bounds[side].extend(at.lower, at.upper, at.center);
        here = *next_left;
        *next_left = item;
        next_left += 1 - side;
    }
    sides.left = static_cast<std::size_t>(next_left - run.data());
    return sides;
}

template <typename T>
Sides<T>
scatter(std::span<const BuildItem<T>> run, const Cut<T>& cut, BuildItem<T>* left, BuildItem<T>* right)
{
    Sides<T> sides;
    BuildItem<T>* next[2]{left, right};
    for (const BuildItem<T>& item : run) {
        const Placed<T> at(item, cut.origin, cut.scale);
        const unsigned side = side_of(at, cut);
        sides.bounds[side].extend(at.lower, at.upper, at.center);
        *next[side]++ = item;
    }
    sides.left = static_cast<std::size_t>(next[0] - left);
    return sides;
}

template <typename T>
std::size_t count_left(std::span<const BuildItem<T>> run, const Cut<T>& cut)
{
    std::size_t count = 0;
    for (const BuildItem<T>& item : run)
        count += 1 - side_of(Placed<T>(item, cut.origin, cut.scale), cut);
    return count;
}

} // namespace

template <typename T>
SplitKernels<T> split_loops()
{
    return {add<T>, best_cut<T>, partition<T>, scatter<T>, count_left<T>};
}
SplitKernels<float> float_loops()
{
    return split_loops<float>();
}
SplitKernels<double> double_loops()
{
    return split_loops<double>();
}

} // namespace renderer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace renderer {

namespace {

template <typename T>
std::vector<SplitKernels<T>> find_loops(SplitKernels<T> (*avx2)(), SplitKernels<T> (*any)())
{
    std::vector<SplitKernels<T>> found;
    if (avx2 != nullptr && (hwy::SupportedTargets() & HWY_AVX2) != 0) found.push_back(avx2());
    found.push_back(any());
    return found;
}

} // namespace

template <>
std::span<const SplitKernels<float>> all_split_kernels()
{
    static const auto found =
        find_loops<float>(HWY_CHOOSE_AVX2(float_loops), HWY_STATIC_DISPATCH(float_loops));
    return found;
}
template <>
std::span<const SplitKernels<double>> all_split_kernels()
{
    static const auto found =
        find_loops<double>(HWY_CHOOSE_AVX2(double_loops), HWY_STATIC_DISPATCH(double_loops));
    return found;
}

template <typename T>
const SplitKernels<T>& split_kernels()
{
    return all_split_kernels<T>().front();
}
template const SplitKernels<float>& split_kernels();
template const SplitKernels<double>& split_kernels();

} // namespace renderer
#endif // HWY_ONCE
