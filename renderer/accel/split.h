// Splits: where a run of primitives is cut in two, by the surface area heuristic or at the midpoint.
//
// Promise  choose and partition are pure functions of the run in its order; both sides are non-empty.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/math/bounds.h"

#include <cstdint>
#include <optional>
#include <span>

namespace renderer {

// A primitive while the tree is built; aligned and padded so that four floats can be loaded at either corner.
template <typename T>
struct alignas(16) BuildItem {
    Vec3<T> lower{};
    std::uint32_t primitive = 0;
    alignas(16) Vec3<T> upper{};

    // Half of each first: the sum may not be finite.
    T center(std::size_t axis) const { return lower[axis] * T(0.5) + upper[axis] * T(0.5); }
};

template <typename T>
struct RunBounds {
    Bounds3<T> box;     // of the boxes
    Bounds3<T> centers; // of their centres
};

template <typename T>
RunBounds<T> bounds_of(std::span<const BuildItem<T>> run);

struct SplitChoice {
    std::size_t left_count;
    double cost; // in tests of a block, the pair's own visit not counted
};

// Cuts by binned surface area heuristic, primitives tested `block` at a time: re-orders the run so that its
// first `left_count` items form the left side; not at all, and left_count 0, where the cost reaches `limit`.
// Nothing if no plane tells the items apart.
template <typename T>
std::optional<SplitChoice>
split_by_sah(std::span<BuildItem<T>> run, const RunBounds<T>& bounds, std::uint32_t block, double limit);

// Cuts at the middle of the centres' longest axis. Nothing if one side stays empty.
template <typename T>
std::optional<std::size_t> split_at_midpoint(std::span<BuildItem<T>> run, const RunBounds<T>& bounds);

// Cuts into halves by count, along the centres' longest axis; always possible for two or more.
template <typename T>
std::size_t split_at_median(std::span<BuildItem<T>> run, const RunBounds<T>& bounds);

} // namespace renderer
