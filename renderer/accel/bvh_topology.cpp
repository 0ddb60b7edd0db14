#include "renderer/accel/bvh_topology.h"

#include <algorithm>
#include <cassert>

namespace renderer {

namespace {

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
    for (std::size_t i = pairs_.size(); i-- > 0;) {
        for (unsigned side = 0; side < 2; ++side) {
            const BvhNode<double>& child = tree.pairs[i].child[side];
            pairs_[i].child[side] = {child.first, child.count};
            assert(child.count != 0 || child.first > i); // pairs come after those that they hang in
        }
        pairs_[i].as_built = visits_of(tree, i, [this](std::size_t below) { return pairs_[below].as_built; });
    }
}

std::optional<Bvh<double>> BvhTopology::refit(std::span<const BuildItem<double>> boxes,
                                              double visits_more) const
{
    const auto has_box = [&](std::uint32_t primitive) { return !box_of(boxes[primitive]).empty(); };
    if (boxes.size() != primitives_ || !std::all_of(order_.begin(), order_.end(), has_box) ||
        static_cast<std::size_t>(std::count_if(boxes.begin(), boxes.end(), [](const auto& item) {
            return !box_of(item).empty();
        })) != order_.size())
        return std::nullopt;
    Bvh<double> tree;
    tree.pairs = PlainArray<BvhPair<double>>(pairs_.size());
    tree.depth = depth_;
    const auto refitted = [&](const Child& child) {
        Bounds3d box;
        if (child.count == 0) box = box_around(tree.pairs[child.first]);
        for (std::uint32_t i = child.first; i < child.first + child.count; ++i)
            box.extend(box_of(boxes[order_[i]]));
        return BvhNode<double>{box.lower, child.first, box.upper, child.count};
    };
    std::vector<Visits> visits(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
        const Pair& pair = pairs_[i];
        tree.pairs[i] = {{refitted(pair.child[0]), refitted(pair.child[1])}};
        visits[i] = visits_of(tree, i, [&](std::size_t below) { return visits[below]; });
        const Visits &now = visits[i], &then = pair.as_built;
        const double anew = then.inner * std::min(1.0, now.leaves / then.leaves);
        if (!(now.inner - anew <= visits_more)) return std::nullopt;
    }
    tree.root = refitted(root_);
    tree.order = order_;
    return tree;
}

} // namespace renderer
