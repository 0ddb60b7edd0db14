#include "renderer/accel/bvh.h"

#include "renderer/accel/split.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

namespace renderer {

namespace {

// A run whose subtree is built apart from the rest, to be hung into `parent`.
struct Subtree {
    std::size_t begin, end;
    unsigned depth;
    std::uint32_t parent, side;
};

template <typename T>
struct Grown {
    std::vector<BvhPair<T>> pairs;
    unsigned depth = 0;
};

template <typename T>
class Grower {
public:
    Grower(std::span<BuildItem<T>> items, const BvhOptions& options, const std::stop_token& stop)
        : items_(items), options_(options), stop_(stop)
    {
    }

    // Grows the tree of [begin, end) into `out`, indices counted from its start. Runs of at most `apart`
    // items are left to `later` when that is given.
    BvhNode<T> grow(std::size_t begin,
                    std::size_t end,
                    unsigned depth,
                    Grown<T>& out,
                    std::size_t apart = 0,
                    std::vector<Subtree>* later = nullptr) const
    {
        const std::span<BuildItem<T>> run = items_.subspan(begin, end - begin);
        const RunBounds<T> bounds = bounds_of<T>(run);
        BvhNode<T> node{bounds.box.lower,
                        static_cast<std::uint32_t>(begin),
                        bounds.box.upper,
                        static_cast<std::uint32_t>(run.size())};
        const std::size_t left = stop_.stop_requested() ? 0 : cut(run, bounds, depth);
        if (left == 0) return node;
        node.count = 0;
        node.first = static_cast<std::uint32_t>(out.pairs.size());
        out.pairs.emplace_back();
        out.depth = std::max(out.depth, depth + 1);
        const std::size_t middle = begin + left;
        for (const auto& [from, to, side] : {Range{begin, middle, 0}, Range{middle, end, 1}}) {
            if (later != nullptr && to - from <= apart) {
                later->push_back({from, to, depth + 1, node.first, side});
            } else {
                const BvhNode<T> child = grow(from, to, depth + 1, out, apart, later);
                out.pairs[node.first].child[side] = child;
            }
        }
        return node;
    }

private:
    struct Range {
        std::size_t from, to;
        std::uint32_t side;
    };

    // How many items go left; 0: this run is a leaf.
    std::size_t cut(std::span<BuildItem<T>> run, const RunBounds<T>& bounds, unsigned depth) const
    {
        if (run.size() < 2) return 0;
        const bool leaf_allowed = run.size() <= options_.leaf_size;
        // Halving n items takes bit_width(n - 1) levels: from here on only that keeps the promise of the
        // depth.
        if (depth + static_cast<unsigned>(std::bit_width(run.size() - 1)) >= kMaxBvhDepth)
            return leaf_allowed ? 0 : split_at_median(run, bounds);
        if (options_.split == BvhSplit::midpoint) {
            if (leaf_allowed) return 0;
            const std::optional<std::size_t> left = split_at_midpoint(run, bounds);
            return left ? *left : split_at_median(run, bounds);
        }
        const std::size_t blocks = (run.size() + options_.block - 1) / options_.block;
        const auto leaf_tests = static_cast<double>(blocks);
        const double limit =
            leaf_allowed ? leaf_tests - options_.node_cost : std::numeric_limits<double>::infinity();
        const std::optional<SplitChoice> choice = split_by_sah(run, bounds, options_.block, limit);
        if (choice) return choice->left_count;
        return leaf_allowed ? 0 : split_at_median(run, bounds);
    }

    std::span<BuildItem<T>> items_;
    const BvhOptions& options_;
    const std::stop_token& stop_;
};

// Hangs a subtree, grown apart, into the tree.
template <typename T>
void hang(Bvh<T>& tree, const Subtree& place, BvhNode<T> top, const Grown<T>& grown)
{
    const auto base = static_cast<std::uint32_t>(tree.pairs.size());
    const auto shifted = [&](BvhNode<T> node) {
        if (node.count == 0) node.first += base;
        return node;
    };
    for (const BvhPair<T>& pair : grown.pairs)
        tree.pairs.push_back({{shifted(pair.child[0]), shifted(pair.child[1])}});
    tree.pairs[place.parent].child[place.side] = shifted(top);
    tree.depth = std::max(tree.depth, grown.depth);
}

} // namespace

template <typename T>
std::optional<Bvh<T>> build_bvh(std::span<const Bounds3<T>> boxes,
                                const BvhOptions& options,
                                ThreadPool& pool,
                                std::stop_token stop)
{
    Bvh<T> tree;
    if (stop.stop_requested()) return std::nullopt;
    if (boxes.empty()) return tree;
    std::vector<BuildItem<T>> items(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        items[i] = {boxes[i].lower, static_cast<std::uint32_t>(i), boxes[i].upper};
    const Grower<T> grower(items, options, stop);

    // What is grown apart depends on the input alone, never on the threads.
    const std::size_t apart = std::max<std::size_t>(4096, boxes.size() / 32);
    std::vector<Subtree> later;
    Grown<T> top;
    tree.root = grower.grow(0, items.size(), 0, top, apart, &later);
    tree.pairs = std::move(top.pairs);
    tree.depth = top.depth;
    std::vector<Grown<T>> grown(later.size());
    std::vector<BvhNode<T>> tops(later.size());
    pool.run(
        later.size(),
        [&](std::size_t i, unsigned) {
            tops[i] = grower.grow(later[i].begin, later[i].end, later[i].depth, grown[i]);
        },
        stop);
    if (stop.stop_requested()) return std::nullopt;

    std::size_t pairs = tree.pairs.size();
    for (const Grown<T>& g : grown)
        pairs += g.pairs.size();
    tree.pairs.reserve(pairs);
    for (std::size_t i = 0; i < later.size(); ++i) {
        hang(tree, later[i], tops[i], grown[i]);
        grown[i] = {}; // as soon as it is copied
    }
    tree.order.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i)
        tree.order[i] = items[i].primitive;
    assert(tree.depth <= kMaxBvhDepth);
    return tree;
}

template std::optional<Bvh<float>>
build_bvh(std::span<const Bounds3f>, const BvhOptions&, ThreadPool&, std::stop_token);
template std::optional<Bvh<double>>
build_bvh(std::span<const Bounds3d>, const BvhOptions&, ThreadPool&, std::stop_token);

} // namespace renderer
