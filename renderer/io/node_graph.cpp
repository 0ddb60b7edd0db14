#include "renderer/io/node_graph.h"

#include <algorithm>

namespace renderer {

namespace {

struct Visit {
    std::size_t node, next = 0; // of its children
};

} // namespace

// Depth first, without calling itself: what is still being visited when it is met again is its own ancestor.
std::optional<ImportFault> NodeGraph::check(const std::string& title) const
{
    enum class State : std::uint8_t { unknown, open, done };
    std::vector<State> states(below_.size(), State::unknown);
    std::vector<std::uint64_t> placed(below_.size(), 1);
    std::vector<std::size_t> heights(below_.size(), 1);
    std::vector<Visit> path;
    for (std::size_t start = 0; start < below_.size(); ++start) {
        if (states[start] == State::unknown) path.push_back({start});
        while (!path.empty()) {
            Visit& visit = path.back();
            const std::size_t node = visit.node;
            states[node] = State::open;
            if (visit.next < below_[node].size()) {
                const std::size_t child = below_[node][visit.next++];
                if (states[child] == State::open)
                    return ImportFault{"malformed",
                                       "node " + std::to_string(child) + " of the " + title +
                                           " is its own ancestor: nodes must form trees"};
                if (states[child] == State::unknown) path.push_back({child});
                continue;
            }
            for (const std::size_t child : below_[node]) {
                placed[node] = std::min(placed[node] + placed[child], kMostPlaced + 1);
                heights[node] = std::max(heights[node], heights[child] + 1);
            }
            if (placed[node] > kMostPlaced)
                return ImportFault{"over_limit",
                                   "node " + std::to_string(node) + " of the " + title +
                                       " stands for more than " + std::to_string(kMostPlaced) + " nodes"};
            if (heights[node] > kDeepest)
                return ImportFault{"over_limit",
                                   "node " + std::to_string(node) + " of the " + title + " has more than " +
                                       std::to_string(kDeepest) + " levels below it"};
            states[node] = State::done;
            path.pop_back();
        }
    }
    return std::nullopt;
}

} // namespace renderer
