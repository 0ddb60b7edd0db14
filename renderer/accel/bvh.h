// Bvh: a binary tree of boxes over any primitives that have boxes; it knows nothing of what lies in them.
//
// Layout   children come in pairs, one cache line (float) each; a leaf is a run of `order`, at most the leaf
//          size asked for, or the primitives that nothing could tell apart.
// Promise  depth at most kMaxBvhDepth whatever the input; the same boxes and split give the same tree on any
//          number of threads. Costs are compared in double after scaling, so coordinates up to 1e301 do not
//          overflow.
// Errors   build_bvh returns nothing only when `stop` was requested.
// Source   I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", RT 2007 (binning);
//          midpoint: M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 3rd ed., section 4.3.1.
#pragma once

#include "renderer/description/settings.h"
#include "renderer/math/bounds.h"
#include "renderer/parallel/thread_pool.h"

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace renderer {

inline constexpr unsigned kMaxBvhDepth = 64; // levels of inner nodes: what a traversal's stack must hold

template <typename T>
struct BvhNode {
    Vec3<T> lower;
    std::uint32_t first = 0; // leaf: where its run of `order` starts; inner: its pair
    Vec3<T> upper;
    std::uint32_t count = 0; // primitives of a leaf; 0: inner
};

template <typename T>
struct alignas(2 * sizeof(BvhNode<T>)) BvhPair {
    BvhNode<T> child[2];
};

template <typename T>
struct Bvh {
    BvhNode<T> root;
    std::vector<BvhPair<T>> pairs;
    std::vector<std::uint32_t> order; // primitives, leaf by leaf
    unsigned depth = 0;               // levels of inner nodes

    bool empty() const { return root.count == 0 && pairs.empty(); }
    std::uint64_t size_bytes() const
    {
        return sizeof *this + pairs.capacity() * sizeof(BvhPair<T>) +
               order.capacity() * sizeof(std::uint32_t);
    }
};

struct BvhOptions {
    BvhSplit split = BvhSplit::sah;
    std::uint32_t leaf_size = 4;
    std::uint32_t block = 1; // primitives that a leaf tests at once
    double node_cost = 1;    // of visiting a pair, in tests of a block
};

// boxes[i] is the box of primitive i: finite and not empty. Fewer than 2^32 - 1 of them.
template <typename T>
std::optional<Bvh<T>> build_bvh(std::span<const Bounds3<T>> boxes,
                                const BvhOptions& options,
                                ThreadPool& pool,
                                std::stop_token stop = {});

extern template std::optional<Bvh<float>>
build_bvh(std::span<const Bounds3f>, const BvhOptions&, ThreadPool&, std::stop_token);
extern template std::optional<Bvh<double>>
build_bvh(std::span<const Bounds3d>, const BvhOptions&, ThreadPool&, std::stop_token);

} // namespace renderer
