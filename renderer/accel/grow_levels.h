// grow_levels: the first levels of a tree, where runs are so long that threads share each of them; what is left are
// subtrees to be grown apart from one another.
//
// Promise  what is cut, and where, depends on the items alone, never on the threads.
#pragma once

#include "renderer/accel/bvh.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace renderer {

// How a run is to be cut.
enum class CutRule { leaf, median, midpoint, sah };
CutRule cut_rule(std::size_t items, unsigned depth, const BvhOptions& options);

// Of a leaf, in tests of a block.
inline double leaf_tests(std::size_t items, const BvhOptions& options)
{
    const std::size_t blocks = (items + options.block - 1) / options.block;
    return static_cast<double>(blocks);
}

// A run of items that is to become a subtree.
template <typename T>
struct Subtree {
    std::size_t begin, end;
    unsigned buffer; // 0: it lies in `items`, 1: in `spare`, at the same place
    RunBounds<T> bounds;
    unsigned depth;
    std::uint32_t parent, side; // of the pair that it hangs in; the whole tree hangs in none

    static constexpr std::uint32_t kNoParent = 0xffffffff;
    std::size_t size() const { return end - begin; }
};

template <typename T>
struct FirstLevels {
    BvhNode<T> root{};
    std::vector<BvhPair<T>> pairs; // those of subtrees are not filled in
    std::vector<Subtree<T>> subtrees;
    unsigned depth = 0;
};

// `spare` is as long as `items`. A whole that is short enough is the only subtree. Where `stop` was requested,
// what comes back means nothing.
template <typename T>
FirstLevels<T> grow_levels(std::span<BuildItem<T>> items,
                           std::span<BuildItem<T>> spare,
                           const BvhOptions& options,
                           ThreadPool& pool,
                           const std::stop_token& stop);

// The longest run that is grown apart, of `items` in all.
std::size_t longest_apart(std::size_t items);

template <typename T>
BvhNode<T> node_over(const RunBounds<T>& bounds, std::size_t first, std::size_t count)
{
    const Bounds3<T> box = bounds.box();
    return {box.lower, static_cast<std::uint32_t>(first), box.upper, static_cast<std::uint32_t>(count)};
}

} // namespace renderer
