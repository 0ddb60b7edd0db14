// Splits: where a run of primitives is cut in two, by the surface area heuristic, at the midpoint or in halves.
//
// Promise  pure functions of the run in its order, whatever the processor; both sides of a cut are non-empty.
// Cost     choosing a cut by surface area reads the run once (into Bins), cutting it once more; that pass knows the
//          bounds of both sides in the end, so no other one looks for them.
#pragma once

#include "renderer/accel/lanes4.h"
#include "renderer/description/settings.h"
#include "renderer/math/bounds.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace renderer {

// A primitive while the tree is built; aligned and padded so that four floats can be loaded at either corner.
template <typename T>
struct alignas(16) BuildItem {
    Vec3<T> lower{};
    std::uint32_t primitive = 0;
    alignas(16) Vec3<T> upper{};
};

// Of a run: the box of its boxes, and that of their centres.
template <typename T>
struct RunBounds {
    Lanes4<T> lower = Lanes4<T>::splat(std::numeric_limits<T>::infinity());
    Lanes4<T> upper = Lanes4<T>::splat(-std::numeric_limits<T>::infinity());
    Lanes4<T> center_lower = lower, center_upper = upper;

    void extend(const BuildItem<T>& item)
    {
        const Lanes4<T> low = Lanes4<T>::load3(item.lower), high = Lanes4<T>::load3(item.upper);
        extend(low, high, center_of(low, high));
    }
    void extend(const RunBounds& other)
    {
        lower = min(other.lower, lower);
        upper = max(other.upper, upper);
        center_lower = min(other.center_lower, center_lower);
        center_upper = max(other.center_upper, center_upper);
    }
    void extend(Lanes4<T> low, Lanes4<T> high, Lanes4<T> center)
    {
        lower = min(low, lower);
        upper = max(high, upper);
        center_lower = min(center, center_lower);
        center_upper = max(center, center_upper);
    }
    // Half of each first: the sum may not be finite.
    static Lanes4<T> center_of(Lanes4<T> low, Lanes4<T> high)
    {
        const Lanes4<T> half = Lanes4<T>::splat(T(0.5));
        return low * half + high * half;
    }
    Bounds3<T> box() const { return bounds_between(lower, upper); }
    Bounds3<T> centers() const { return bounds_between(center_lower, center_upper); }

private:
    static Bounds3<T> bounds_between(Lanes4<T> low, Lanes4<T> high)
    {
        alignas(16) T l[4], u[4];
        low.store(l);
        high.store(u);
        return {{l[0], l[1], l[2]}, {u[0], u[1], u[2]}};
    }
};

template <typename T>
unsigned longest_axis(const Bounds3<T>& box)
{
    // Halves, so that the extent of the whole range of T stays finite.
    const Vec3<T> half = box.upper * T(0.5) - box.lower * T(0.5);
    return half.x >= half.y ? (half.x >= half.z ? 0u : 2u) : (half.y >= half.z ? 1u : 2u);
}

// Where items go left: those whose centre, less `origin` and times `scale`, is below `below` along the axis.
template <typename T>
struct Cut {
    Lanes4<T> origin, scale;
    T below = 0;
    unsigned axis = 0;
};

// A run counted in slices of equal width along each axis, to choose a cut from; what is counted in parts can be
// merged. Those of neighbouring parts, each another thread's, share no cache line.
template <typename T>
struct alignas(128) Bins {
    static constexpr std::size_t kMost = 16;
    struct Box {
        Lanes4<T> lower, upper;
    };

    // For `count` items within `bounds`.
    Bins(const RunBounds<T>& bounds, std::size_t count);

    void merge(const Bins& other);                   // made for the same bounds and count
    std::size_t count_left(const Cut<T>& cut) const; // of a cut that bins for the same bounds have chosen

    Lanes4<T> origin, scale;
    std::size_t bins;    // along each axis
    unsigned usable = 0; // bit a: items differ along axis a
    Box boxes[kMost][3];
    alignas(16) std::int32_t counts[kMost][4];
};

template <typename T>
struct Sides {
    std::size_t left = 0; // items that went there
    RunBounds<T> bounds[2];
};

// The loops over items, once for AVX2 and once for any processor: the same to the last bit.
template <typename T>
struct SplitKernels {
    void (*add)(Bins<T>& bins, std::span<const BuildItem<T>> run);
    // The cheapest cut, primitives tested `block` (a power of two) at a time, if it costs less than `limit` (in
    // tests of a block, the pair's own visit not counted). Nothing if none does, or no plane tells the items apart.
    std::optional<Cut<T>> (*best_cut)(const Bins<T>& bins,
                                      const RunBounds<T>& bounds,
                                      std::uint32_t block,
                                      double limit);
    // Re-orders the run so that its first items form the left side.
    Sides<T> (*partition)(std::span<BuildItem<T>> run, const Cut<T>& cut);
    // Copies the run's items to two places, in their order.
    Sides<T> (*scatter)(std::span<const BuildItem<T>> run,
                        const Cut<T>& cut,
                        BuildItem<T>* left,
                        BuildItem<T>* right);
    std::size_t (*count_left)(std::span<const BuildItem<T>> run, const Cut<T>& cut);
};

// The best of this processor.
template <typename T>
const SplitKernels<T>& split_kernels();
// All that this processor can run, the best first. For tests.
template <typename T>
std::span<const SplitKernels<T>> all_split_kernels();

// The cut at the middle of the centres' longest axis. Nothing if one side stays empty.
template <typename T>
std::optional<Cut<T>> cut_at_midpoint(const RunBounds<T>& bounds);

// Cuts into halves by count, along the centres' longest axis; always possible for two or more.
template <typename T>
Sides<T> split_at_median(std::span<BuildItem<T>> run, const RunBounds<T>& bounds);

} // namespace renderer
