// Bvh: a binary tree of boxes over any primitives that have boxes; it knows nothing of what lies in them.
//
// Layout   children come in pairs, one cache line (float) each; a leaf is a run of `order`, at most the leaf
//          size asked for, or the primitives that nothing could tell apart.
// Promise  depth at most kMaxBvhDepth whatever the input; the same items and options give the same tree on any
//          number of threads and any processor. Costs are compared after scaling, so coordinates up to 1e301 do
//          not overflow.
// Memory   while it is built: the items twice, and the pairs, of those that many threads share twice.
// Errors   build_bvh returns nothing only when `stop` was requested.
// Source   I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", RT 2007 (binning);
//          midpoint: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd ed., section 4.3.1.
#pragma once

#include "renderer/accel/plain_array.h"
#include "renderer/accel/split.h"
#include "renderer/description/settings.h"
#include "renderer/parallel/thread_pool.h"

#include <cstdint>
#include <optional>
#include <stop_token>

namespace renderer {

inline constexpr unsigned kMaxBvhDepth = 64; // levels of inner nodes: what a traversal's stack must hold

template <typename T>
struct BvhNode {
    Vec3<T> lower;
    std::uint32_t first; // leaf: where its run of `order` starts; inner: its pair
    Vec3<T> upper;
    std::uint32_t count; // primitives of a leaf; 0: inner
};

template <typename T>
struct alignas(2 * sizeof(BvhNode<T>)) BvhPair {
    BvhNode<T> child[2];
};

// Of a tree's root. All others: 2 * pair + side.
inline constexpr std::uint32_t kRootNumber = 0xffffffff;

template <typename T>
struct Bvh {
    BvhNode<T> root{};
    PlainArray<BvhPair<T>> pairs;
    PlainArray<std::uint32_t> order; // primitives, leaf by leaf
    unsigned depth = 0;              // levels of inner nodes

    BvhNode<T>& node(std::uint32_t number)
    {
        return number == kRootNumber ? root : pairs[number >> 1].child[number & 1];
    }
    const BvhNode<T>& node(std::uint32_t number) const { return const_cast<Bvh&>(*this).node(number); }
    bool empty() const { return order.empty(); }
    std::uint64_t size_bytes() const { return sizeof *this + pairs.size_bytes() + order.size_bytes(); }
};

struct BvhOptions {
    BvhSplit split = BvhSplit::sah;
    std::uint32_t leaf_size = 4;
    std::uint32_t block = 1; // primitives that a leaf tests at once: a power of two
    double node_cost = 1;    // of visiting a pair, in tests of a block
};

// Boxes finite and not empty; fewer than 2^31 of them. `items` are used up.
template <typename T>
std::optional<Bvh<T>> build_bvh(PlainArray<BuildItem<T>> items,
                                const BvhOptions& options,
                                ThreadPool& pool,
                                std::stop_token stop = {});

extern template std::optional<Bvh<float>>
build_bvh(PlainArray<BuildItem<float>>, const BvhOptions&, ThreadPool&, std::stop_token);
extern template std::optional<Bvh<double>>
build_bvh(PlainArray<BuildItem<double>>, const BvhOptions&, ThreadPool&, std::stop_token);

} // namespace renderer
