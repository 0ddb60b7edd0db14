#include "renderer/accel/bvh_topology.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>

namespace renderer {

namespace {

constexpr std::size_t kMostInAPiece = 1024;

Bounds3d box_of(const BvhNode<double>& node)
{
    return {node.lower, node.upper};
}

Bounds3d box_of(const BuildItem<double>& item)
{
    return {item.lower, item.upper};
}

Bounds3d box_around(const BvhPair<double>& pair)
{
    Bounds3d box = box_of(pair.child[0]);
    box.extend(box_of(pair.child[1]));
    return box;
}

// Inner nodes that a ray visits in trees built over so many primitives in a volume, on a floor or a shell, small and large:
// at most 2.8 of the cube root, and twice the leaves (100 to 100,000, at every node). Long thin ones that cross need more.
double most_visits(double primitives, double leaves)
{
    return 3 * std::cbrt(primitives) + 2 * leaves;
}

} // namespace

// `below(p)` is the same of pair p. Of a box without area it is not a number, which is never good.
template <typename At>
BvhTopology::Visits BvhTopology::visits_of(const Bvh<double>& tree, std::size_t pair, const At& below)
{
    Visits sum;
    for (const BvhNode<double>& child : tree.pairs[pair].child) {
        const double area = half_area(box_of(child));
        if (child.count != 0) {
            sum.leaves += area;
            continue;
        }
        const Visits& there = below(child.first);
        sum.inner += area * there.inner;
        sum.leaves += area * there.leaves;
    }
    const double whole = half_area(box_around(tree.pairs[pair]));
    return {1 + sum.inner / whole, sum.leaves / whole};
}

BvhTopology::BvhTopology(const Bvh<double>& tree, std::size_t primitives)
    : pairs_(tree.pairs.size()), order_(tree.order), root_{tree.root.first, tree.root.count},
      depth_(tree.depth), primitives_(primitives)
{
    std::vector<Visits> visits(pairs_.size());
    std::vector<std::uint32_t> held(pairs_.size()); // primitives
    for (std::size_t i = pairs_.size(); i-- > 0;) {
        for (unsigned side = 0; side < 2; ++side) {
            const BvhNode<double>& child = tree.pairs[i].child[side];
            pairs_[i].child[side] = {child.first, child.count};
            assert(child.count != 0 || child.first > i); // pairs come after those that they hang in
            held[i] += child.count != 0 ? child.count : held[child.first];
        }
        visits[i] = visits_of(tree, i, [&](std::size_t below) { return visits[below]; });
        pairs_[i].as_built = visits[i];
        pairs_[i].as_built.inner = std::min(visits[i].inner, most_visits(held[i], visits[i].leaves));
    }
    cut_in_pieces();
}

void BvhTopology::cut_in_pieces()
{
    struct Reach {
        std::uint32_t size, last; // pairs, and the last of them
    };
    std::vector<Reach> reach(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
        reach[i] = {1, static_cast<std::uint32_t>(i)};
        for (const Child& child : pairs_[i].child) {
            if (child.count != 0) continue;
            reach[i].size += reach[child.first].size;
            reach[i].last = std::max(reach[i].last, reach[child.first].last);
        }
    }
    for (std::uint32_t i = 0; i < pairs_.size();) {
        const auto [size, last] = reach[i];
        if (size <= kMostInAPiece && last == i + size - 1) {
            pieces_.push_back({i, i + size});
            i += size;
        } else {
            above_.push_back(i++);
        }
    }
}

bool BvhTopology::is_of_use() const
{
    if (pairs_.empty()) return false;
    const Visits& whole = pairs_[root_.first].as_built;
    return std::isfinite(whole.inner + whole.leaves);
}

class BvhTopology::Refit {
public:
    Refit(const BvhTopology& topology, std::span<const BuildItem<double>> boxes, double visits_more)
        : topology_(topology), boxes_(boxes), visits_more_(visits_more), visits_(topology.pairs_.size())
    {
        tree_.pairs = PlainArray<BvhPair<double>>(topology.pairs_.size());
    }

    // What is below it is done. False where the tree is not to be had.
    bool fit(std::size_t pair)
    {
        const Pair& there = topology_.pairs_[pair];
        if (!fit(there.child[0], tree_.pairs[pair].child[0]) ||
            !fit(there.child[1], tree_.pairs[pair].child[1]))
            return false;
        visits_[pair] = visits_of(tree_, pair, [this](std::size_t below) { return visits_[below]; });
        const Visits &now = visits_[pair], &then = there.as_built;
        const double anew = then.inner * std::min(1.0, now.leaves / then.leaves);
        return now.inner - anew <= visits_more_;
    }
    std::optional<Bvh<double>> finish()
    {
        if (!fit(topology_.root_, tree_.root)) return std::nullopt;
        tree_.order = topology_.order_;
        tree_.depth = topology_.depth_;
        return std::move(tree_);
    }

private:
    // False where a primitive has no box.
    bool fit(const Child& child, BvhNode<double>& node) const
    {
        Bounds3d box;
        if (child.count == 0) box = box_around(tree_.pairs[child.first]);
        for (std::uint32_t i = child.first; i < child.first + child.count; ++i) {
            const Bounds3d one = box_of(boxes_[topology_.order_[i]]);
            if (one.empty()) return false;
            box.extend(one);
        }
        node = {box.lower, child.first, box.upper, child.count};
        return true;
    }

    const BvhTopology& topology_;
    std::span<const BuildItem<double>> boxes_;
    double visits_more_;
    std::vector<Visits> visits_;
    Bvh<double> tree_;
};

std::optional<Bvh<double>>
BvhTopology::refit(std::span<const BuildItem<double>> boxes, double visits_more, ThreadPool& pool) const
{
    const auto have_boxes = std::count_if(
        boxes.begin(), boxes.end(), [](const BuildItem<double>& item) { return !box_of(item).empty(); });
    if (boxes.size() != primitives_ || static_cast<std::size_t>(have_boxes) != order_.size() ||
        order_.empty())
        return std::nullopt;
    Refit refit(*this, boxes, visits_more);
    std::atomic<bool> is_good = true;
    pool.run_near(pieces_.size(), [&](std::size_t piece, unsigned) {
        for (std::size_t i = pieces_[piece].end; i-- > pieces_[piece].begin && is_good;)
            if (!refit.fit(i)) is_good = false;
    });
    for (auto pair = above_.rbegin(); pair != above_.rend() && is_good; ++pair)
        if (!refit.fit(*pair)) is_good = false;
    if (!is_good) return std::nullopt;
    return refit.finish();
}

} // namespace renderer
