#include "renderer/accel/bvh.h"

#include "renderer/accel/grow_levels.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace renderer {

namespace {

template <typename T>
struct Grown {
    BvhNode<T> top;
    std::vector<BvhPair<T>> pairs; // counted from its start
    unsigned depth = 0;
};

// Grows one subtree, depth first; leaves are written into `order`.
template <typename T>
class Grower {
public:
    Grower(const BvhOptions& options, const std::stop_token& stop, std::uint32_t* order)
        : options_(options), stop_(stop), order_(order)
    {
    }

    // A run whose first place in `order` is `begin`.
    BvhNode<T> grow(std::span<BuildItem<T>> run,
                    const RunBounds<T>& bounds,
                    std::size_t begin,
                    unsigned depth,
                    Grown<T>& out) const
    {
        Sides<T> sides;
        if (stop_.stop_requested() || !cut(run, bounds, depth, sides)) {
            for (std::size_t i = 0; i < run.size(); ++i)
                order_[begin + i] = run[i].primitive;
            return node_over(bounds, begin, run.size());
        }
        const std::size_t pair = out.pairs.size();
        out.pairs.emplace_back();
        out.depth = std::max(out.depth, depth + 1);
        const BvhNode<T> left = grow(run.first(sides.left), sides.bounds[0], begin, depth + 1, out);
        const BvhNode<T> right =
            grow(run.subspan(sides.left), sides.bounds[1], begin + sides.left, depth + 1, out);
        out.pairs[pair] = {{left, right}};
        return node_over(bounds, pair, 0);
    }

private:
    // False: the run is a leaf.
    bool cut(std::span<BuildItem<T>> run, const RunBounds<T>& bounds, unsigned depth, Sides<T>& sides) const
    {
        std::optional<Cut<T>> chosen;
        switch (cut_rule(run.size(), depth, options_)) {
        case CutRule::leaf:
            return false;
        case CutRule::median:
            break;
        case CutRule::midpoint:
            chosen = cut_at_midpoint(bounds);
            break;
        case CutRule::sah: {
            const bool leaf_allowed = run.size() <= options_.leaf_size;
            const double limit = leaf_allowed ? leaf_tests(run.size(), options_) - options_.node_cost
                                              : std::numeric_limits<double>::infinity();
            Bins<T> bins(bounds, run.size());
            kernels_.add(bins, run);
            chosen = kernels_.best_cut(bins, bounds, options_.block, limit);
            if (!chosen && leaf_allowed) return false;
        }
        }
        sides = chosen ? kernels_.partition(run, *chosen) : split_at_median(run, bounds);
        return true;
    }

    const BvhOptions& options_;
    const std::stop_token& stop_;
    std::uint32_t* order_;
    const SplitKernels<T>& kernels_ = split_kernels<T>();
};

// Puts what was grown apart into one array.
template <typename T>
void join(Bvh<T>& tree, FirstLevels<T>& top, std::vector<Grown<T>>& grown, ThreadPool& pool)
{
    std::vector<std::size_t> first(grown.size());
    std::size_t pairs = top.pairs.size();
    for (std::size_t i = 0; i < grown.size(); ++i) {
        first[i] = pairs;
        pairs += grown[i].pairs.size();
    }
    tree.root = top.root;
    tree.pairs = PlainArray<BvhPair<T>>(pairs);
    std::copy(top.pairs.begin(), top.pairs.end(), tree.pairs.begin());
    pool.run(grown.size(), [&](std::size_t i, unsigned) {
        const auto moved = [&](BvhNode<T> node) {
            if (node.count == 0) node.first += static_cast<std::uint32_t>(first[i]);
            return node;
        };
        BvhPair<T>* to = tree.pairs.data() + first[i];
        for (const BvhPair<T>& pair : grown[i].pairs)
            *to++ = {{moved(pair.child[0]), moved(pair.child[1])}};
        const Subtree<T>& place = top.subtrees[i];
        (place.parent == Subtree<T>::kNoParent ? tree.root : tree.pairs[place.parent].child[place.side]) =
            moved(grown[i].top);
        grown[i].pairs = {}; // as soon as it is copied
    });
    tree.depth = top.depth;
    for (const Grown<T>& g : grown)
        tree.depth = std::max(tree.depth, g.depth);
}

} // namespace

template <typename T>
std::optional<Bvh<T>>
build_bvh(PlainArray<BuildItem<T>> items, const BvhOptions& options, ThreadPool& pool, std::stop_token stop)
{
    Bvh<T> tree;
    if (stop.stop_requested()) return std::nullopt;
    if (items.empty()) return tree;
    tree.order = PlainArray<std::uint32_t>(items.size());
    PlainArray<BuildItem<T>> spare(items.size() > longest_apart(items.size()) ? items.size() : 0);
    const std::span<BuildItem<T>> buffers[2]{{items.data(), items.size()}, {spare.data(), spare.size()}};
    FirstLevels<T> top = grow_levels(buffers[0], buffers[1], options, pool, stop);
    if (stop.stop_requested()) return std::nullopt;

    std::vector<Grown<T>> grown(top.subtrees.size());
    const Grower<T> grower(options, stop, tree.order.data());
    pool.run_near(
        grown.size(),
        [&](std::size_t i, unsigned) {
            const Subtree<T>& tree_at = top.subtrees[i];
            Grown<T> here; // where it will lie, its neighbour in the cache line is another thread's
            here.pairs.reserve(tree_at.size() / 3);
            here.top = grower.grow(buffers[tree_at.buffer].subspan(tree_at.begin, tree_at.size()),
                                   tree_at.bounds,
                                   tree_at.begin,
                                   tree_at.depth,
                                   here);
            grown[i] = std::move(here);
        },
        stop);
    if (stop.stop_requested()) return std::nullopt;
    items = PlainArray<BuildItem<T>>();
    spare = PlainArray<BuildItem<T>>();
    join(tree, top, grown, pool);
    assert(tree.depth <= kMaxBvhDepth);
    return tree;
}

template std::optional<Bvh<float>>
build_bvh(PlainArray<BuildItem<float>>, const BvhOptions&, ThreadPool&, std::stop_token);
template std::optional<Bvh<double>>
build_bvh(PlainArray<BuildItem<double>>, const BvhOptions&, ThreadPool&, std::stop_token);

} // namespace renderer
