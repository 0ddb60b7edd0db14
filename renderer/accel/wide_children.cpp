#include "renderer/accel/wide_children.h"

#include <algorithm>
#include <vector>

namespace renderer {

WideChildren::WideChildren(const Bvh<float>& bvh, ThreadPool& pool) : bvh_(bvh), costs_(bvh.pairs.size())
{
    std::vector<std::uint32_t> open{kRootNumber}; // parents before children
    std::size_t first = 0;
    for (; first < open.size() && open.size() - first < kPieces; ++first)
        if (const BvhNode<float>& node = bvh.node(open[first]); node.count == 0)
            for (std::uint32_t side = 0; side < 2; ++side)
                open.push_back(2 * node.first + side);
    pool.run(open.size() - first, [&](std::size_t i, unsigned) { add_up(open[first + i]); });
    while (first-- > 0)
        add_up_pair(open[first]);
}

WideChildren::Chosen WideChildren::of(std::uint32_t number) const
{
    Chosen chosen;
    if (bvh_.node(number).count == 0)
        part(bvh_.node(number).first, WideNode::kChildren, chosen);
    else
        chosen.node[chosen.count++] = number;
    return chosen;
}

float WideChildren::cost(std::uint32_t number, unsigned places) const
{
    const BvhNode<float>& node = bvh_.node(number);
    return node.count == 0 ? costs_[node.first].with[places - 1] : 0;
}

// `left` of the places to the first of the pair.
float WideChildren::cost_of_parting(std::uint32_t pair, unsigned places, unsigned left) const
{
    return cost(2 * pair, left) + cost(2 * pair + 1, places - left);
}

void WideChildren::add_up(std::uint32_t number)
{
    const BvhNode<float>& node = bvh_.node(number);
    if (node.count != 0) return;
    add_up(2 * node.first);
    add_up(2 * node.first + 1);
    add_up_pair(number);
}

// What lies below its children is known.
void WideChildren::add_up_pair(std::uint32_t number)
{
    const BvhNode<float>& node = bvh_.node(number);
    if (node.count != 0) return;
    Costs costs;
    for (unsigned places = 2; places <= WideNode::kChildren; ++places) {
        float least = cost_of_parting(node.first, places, 1);
        for (unsigned left = 2; left < places; ++left)
            least = std::min(least, cost_of_parting(node.first, places, left));
        costs.with[places - 1] = least;
    }
    const auto area = static_cast<float>(half_area({node.lower, node.upper}));
    costs.with[0] = costs.with[WideNode::kChildren - 1] + area;
    for (unsigned i = 1; i < WideNode::kChildren; ++i)
        costs.with[i] = std::min(costs.with[i], costs.with[0]);
    costs_[node.first] = costs;
}

// The node itself, or nodes below it in its place.
void WideChildren::choose(std::uint32_t number, unsigned places, Chosen& out) const
{
    if (cost(number, places) < cost(number, 1))
        part(bvh_.node(number).first, places, out);
    else
        out.node[out.count++] = number;
}

void WideChildren::part(std::uint32_t pair, unsigned places, Chosen& out) const
{
    unsigned best = 1;
    for (unsigned left = 2; left < places; ++left)
        if (cost_of_parting(pair, places, left) < cost_of_parting(pair, places, best)) best = left;
    choose(2 * pair, best, out);
    choose(2 * pair + 1, places - best, out);
}

} // namespace renderer
