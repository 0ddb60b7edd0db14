#include "renderer/accel/reinsertion.h"

#include "renderer/accel/lanes4.h"

#include <algorithm>
#include <cstddef>
#include <queue>
#include <utility>
#include <vector>

namespace renderer {

namespace {

// Those that are moved, the largest ones: a fiftieth of all pairs, and so many more.
constexpr std::size_t kPairsToOne = 50, kAlways = 256;
constexpr unsigned kMostRounds = 16;
// A round that saves a ray through the whole fewer visits than this is the last.
constexpr float kFewestVisits = 0.5f;

struct Box {
    Lanes4<float> lower, upper;

    float half_area() const
    {
        alignas(16) float e[4];
        (upper - lower).store(e);
        return e[0] * (e[1] + e[2]) + e[1] * e[2];
    }
};

Box box_of(const BvhNode<float>& node)
{
    return {Lanes4<float>::load3(node.lower), Lanes4<float>::load3(node.upper)};
}

Box around(const Box& a, const Box& b)
{
    return {min(a.lower, b.lower), max(a.upper, b.upper)};
}

// A subtree is taken out, its sibling takes its parent's place, and the parent is put where another node was, above
// both.
struct Move {
    std::uint32_t node, beside;
    float gain; // of area, in all inner nodes; not above 0: there is none
};

bool goes_first(const Move& a, const Move& b)
{
    return a.gain > b.gain || (a.gain == b.gain && a.node < b.node);
}

class Reinserter {
public:
    explicit Reinserter(Bvh<float>& tree)
        : tree_(tree), parent_(tree.pairs.size()), height_(tree.pairs.size()), touched_(tree.pairs.size())
    {
        for (std::size_t pair = tree.pairs.size(); pair-- > 0;) {
            for (std::size_t side = 0; side < 2; ++side)
                if (const BvhNode<float>& child = tree.pairs[pair].child[side]; child.count == 0)
                    parent_[child.first] = static_cast<std::uint32_t>(2 * pair + side);
            height_[pair] = height_over(pair); // of those behind it is known
        }
        parent_[tree.root.first] = kRootNumber;
    }

    void run(ThreadPool& pool, const std::stop_token& stop)
    {
        const float enough = kFewestVisits * box_of(tree_.root).half_area();
        const std::vector<std::uint32_t> largest = largest_nodes(tree_.pairs.size() / kPairsToOne + kAlways);
        std::vector<Move> moves(largest.size());
        for (unsigned round = 0; round < kMostRounds && !stop.stop_requested(); ++round) {
            constexpr std::size_t kPiece = 64;
            pool.run((largest.size() + kPiece - 1) / kPiece, [&](std::size_t piece, unsigned) {
                const std::size_t end = std::min(largest.size(), (piece + 1) * kPiece);
                for (std::size_t i = piece * kPiece; i < end; ++i)
                    moves[i] = best_move(largest[i]);
            });
            std::sort(moves.begin(), moves.end(), goes_first);
            if (apply_those_apart(moves) < enough) break;
        }
        tree_.depth = height_[tree_.root.first];
    }

private:
    BvhNode<float>& node(std::uint32_t number) const { return tree_.node(number); }

    unsigned height(const BvhNode<float>& node) const { return node.count == 0 ? height_[node.first] : 0; }

    std::uint8_t height_over(std::size_t pair) const
    {
        const BvhNode<float>(&child)[2] = tree_.pairs[pair].child;
        return static_cast<std::uint8_t>(1 + std::max(height(child[0]), height(child[1])));
    }

    // Without the root; fewer where there are no more.
    std::vector<std::uint32_t> largest_nodes(std::size_t count) const
    {
        std::priority_queue<std::pair<float, std::uint32_t>> seen;
        std::vector<std::uint32_t> largest;
        const auto see_pair = [&](std::uint32_t pair) {
            for (std::uint32_t number = 2 * pair; number < 2 * pair + 2; ++number)
                seen.emplace(box_of(node(number)).half_area(), number);
        };
        see_pair(tree_.root.first);
        while (!seen.empty() && largest.size() < count) {
            const std::uint32_t number = seen.top().second;
            seen.pop();
            largest.push_back(number);
            if (node(number).count == 0) see_pair(node(number).first);
        }
        return largest;
    }

    // Branch and bound: from the node's parent up to the root, at each level through what hangs on the other side.
    Move best_move(std::uint32_t number) const
    {
        Move best{number, number, 0};
        const std::uint32_t parent = parent_[number >> 1], own_sibling = number ^ 1;
        if (parent == kRootNumber) return best; // whose box stays as it is
        const Box own = box_of(node(number));
        const float own_area = own.half_area();

        // `saved`: what taking the node out, and what lies above a place would grow by, come to so far.
        struct Place {
            std::uint32_t node;
            float saved, with_own; // area of both together
        };
        Place waiting[2 * kMaxBvhDepth];
        unsigned count = 0;
        const auto place = [&](std::uint32_t at, float saved) {
            return Place{at, saved, around(box_of(node(at)), own).half_area()};
        };
        const auto look_below = [&](std::uint32_t at, float saved) {
            if (node(at).count != 0 || saved - own_area <= best.gain) return;
            const Place a = place(2 * node(at).first, saved), b = place(2 * node(at).first + 1, saved);
            const bool a_first = a.with_own < b.with_own;
            waiting[count++] = a_first ? b : a;
            waiting[count++] = a_first ? a : b;
        };
        const auto search = [&] {
            while (count > 0) {
                const Place here = waiting[--count];
                const float gain = here.saved - here.with_own;
                if (gain > best.gain) best = {number, here.node, gain};
                look_below(here.node, gain + box_of(node(here.node)).half_area());
            }
        };

        Box without = box_of(node(own_sibling)); // what is left of the pivot's box
        float saved = box_of(node(parent)).half_area();
        look_below(own_sibling, saved - around(without, own).half_area() + without.half_area());
        search();
        for (std::uint32_t pivot = parent; pivot != kRootNumber;) {
            const std::uint32_t sibling = pivot ^ 1;
            waiting[count++] = place(sibling, saved);
            search();
            without = around(without, box_of(node(sibling)));
            pivot = parent_[pivot >> 1];
            saved += box_of(node(pivot)).half_area() - without.half_area();
        }
        return best;
    }

    // In their order, but for those that meet an earlier one. What they gain.
    float apply_those_apart(const std::vector<Move>& moves)
    {
        float gain = 0;
        std::vector<std::uint32_t> touched;
        for (const Move& move : moves) {
            if (!(move.gain > 0)) break;
            const std::uint32_t pair = move.node >> 1, above = parent_[pair];
            const std::uint32_t met[3] = {pair, above == kRootNumber ? pair : above >> 1, move.beside >> 1};
            const auto is_touched = [&](std::uint32_t p) { return touched_[p]; };
            if (std::any_of(met, met + 3, is_touched) || !is_possible(move)) continue;
            for (const std::uint32_t p : met) {
                touched_[p] = true;
                touched.push_back(p);
            }
            apply(move);
            gain += move.gain;
        }
        for (const std::uint32_t pair : touched)
            touched_[pair] = false;
        return gain;
    }

    // Not into itself, where earlier moves have led, and not too deep.
    bool is_possible(const Move& move) const
    {
        unsigned levels = 1;
        for (std::uint32_t up = move.beside; up != kRootNumber; up = parent_[up >> 1], ++levels)
            if (up == move.node) return false;
        return levels + std::max(height(node(move.node)), height(node(move.beside))) <= kMaxBvhDepth;
    }

    void apply(const Move& move)
    {
        const std::uint32_t pair = move.node >> 1, sibling = move.node ^ 1, above = parent_[pair];
        put(above, node(sibling));
        put(sibling, node(move.beside));
        put(move.beside, {{}, pair, {}, 0});
        if (above != kRootNumber) refit(parent_[above >> 1]);
        refit(move.beside);
    }

    void put(std::uint32_t number, BvhNode<float> what)
    {
        node(number) = what;
        if (what.count == 0) parent_[what.first] = number;
    }

    // An inner node and all above it.
    void refit(std::uint32_t number)
    {
        for (;; number = parent_[number >> 1]) {
            BvhNode<float>& inner = node(number);
            const BvhNode<float>(&child)[2] = tree_.pairs[inner.first].child;
            Bounds3f box{child[0].lower, child[0].upper};
            box.extend({child[1].lower, child[1].upper});
            inner.lower = box.lower;
            inner.upper = box.upper;
            height_[inner.first] = height_over(inner.first);
            if (number == kRootNumber) return;
        }
    }

    Bvh<float>& tree_;
    std::vector<std::uint32_t> parent_; // of pairs: the node whose children they are
    std::vector<std::uint8_t> height_;  // of pairs: levels of inner nodes, from here
    std::vector<bool> touched_;         // pairs, by moves of this round
};

} // namespace

void reinsert_largest(Bvh<float>& tree, ThreadPool& pool, const std::stop_token& stop)
{
    if (tree.pairs.size() >= 2) Reinserter(tree).run(pool, stop);
}

} // namespace renderer
