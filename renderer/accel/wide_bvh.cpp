#include "renderer/accel/wide_bvh.h"

#include "renderer/accel/wide_children.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace renderer {

namespace {

WideNode empty_node()
{
    WideNode node{};
    for (std::size_t row = 0; row < 6; ++row)
        for (float& plane : node.planes[row])
            plane = row % 2 == 0 ? std::numeric_limits<float>::infinity()
                                 : -std::numeric_limits<float>::infinity();
    return node;
}

using Chosen = WideChildren::Chosen;

// A subtree: its nodes in the order in which they will lie, inner children of each in a row.
struct Piece {
    std::vector<Chosen> nodes;
    std::vector<std::uint32_t> first_inner; // of a node's children, counted as `nodes` is
    std::uint32_t blocks = 0;
    unsigned depth = 0;
    std::uint32_t node_offset = 0, block_offset = 0; // of all but the piece's root, in the whole tree
};

class Widening {
public:
    Widening(const Bvh<float>& bvh, const LeafFiller& leaves, ThreadPool& pool)
        : bvh_(bvh), leaves_(leaves), pool_(pool), children_(bvh, pool)
    {
    }

    WideBvh run()
    {
        WideBvh wide;
        wide.bounds = {bvh_.root.lower, bvh_.root.upper};
        choose_first();
        const auto inside = static_cast<std::uint32_t>(first_.nodes.size());
        std::vector<Piece> pieces(open_.size() - inside);
        pool_.run(pieces.size(), [&](std::size_t i, unsigned) {
            Piece piece; // where it will lie, its neighbour in the cache line is another thread's
            add_node(piece, open_[inside + i].node);
            choose_below(piece, 0, open_[inside + i].depth);
            pieces[i] = std::move(piece);
        });

        // The first nodes, then the roots of the pieces, then what is below each of those.
        auto nodes = static_cast<std::uint32_t>(open_.size());
        std::uint32_t blocks = first_.blocks;
        wide.depth = first_.depth;
        for (Piece& piece : pieces) {
            piece.node_offset = nodes - 1;
            piece.block_offset = blocks;
            nodes += static_cast<std::uint32_t>(piece.nodes.size()) - 1;
            blocks += piece.blocks;
            wide.depth = std::max(wide.depth, piece.depth);
        }
        wide.nodes = PlainArray<WideNode>(nodes);
        leaves_.reserve(blocks);
        std::uint32_t block = 0;
        for (std::uint32_t i = 0; i < inside; ++i)
            fill(wide.nodes[i], first_.nodes[i], first_.first_inner[i], block);
        pool_.run(pieces.size(), [&](std::size_t i, unsigned) {
            const Piece& piece = pieces[i];
            std::uint32_t piece_block = piece.block_offset;
            for (std::uint32_t k = 0; k < piece.nodes.size(); ++k)
                fill(wide.nodes[k == 0 ? inside + i : piece.node_offset + k],
                     piece.nodes[k],
                     piece.node_offset + piece.first_inner[k],
                     piece_block);
        });
        return wide;
    }

private:
    struct Open {
        std::uint32_t node;
        unsigned depth;
    };

    const BvhNode<float>& node(std::uint32_t number) const { return bvh_.node(number); }

    std::uint32_t add_node(Piece& piece, std::uint32_t number) const
    {
        piece.nodes.push_back(children_.of(number));
        piece.first_inner.push_back(0);
        return static_cast<std::uint32_t>(piece.nodes.size() - 1);
    }

    // Counts the blocks of its leaves; hands over its inner children.
    template <typename Take>
    void look_at(Piece& piece, const Chosen& chosen, unsigned depth, Take&& take) const
    {
        piece.depth = std::max(piece.depth, depth);
        for (unsigned i = 0; i < chosen.count; ++i)
            if (const std::uint32_t count = node(chosen.node[i]).count; count != 0)
                piece.blocks += leaves_.blocks(count);
            else
                take(chosen.node[i]);
    }

    // Level by level, until there are enough pieces to share.
    void choose_first()
    {
        open_.push_back({kRootNumber, 1});
        for (std::size_t next = 0; next < open_.size() && open_.size() - next < WideChildren::kPieces;
             ++next) {
            const Open here = open_[next];
            const std::uint32_t at = add_node(first_, here.node);
            first_.first_inner[at] = static_cast<std::uint32_t>(open_.size());
            look_at(first_, first_.nodes[at], here.depth, [&](std::uint32_t child) {
                open_.push_back({child, here.depth + 1});
            });
        }
    }

    void choose_below(Piece& piece, std::uint32_t at, unsigned depth) const
    {
        const auto first = static_cast<std::uint32_t>(piece.nodes.size());
        piece.first_inner[at] = first;
        const Chosen chosen = piece.nodes[at];
        look_at(piece, chosen, depth, [&](std::uint32_t child) { add_node(piece, child); });
        const auto end = static_cast<std::uint32_t>(piece.nodes.size());
        for (std::uint32_t inner = first; inner < end; ++inner)
            choose_below(piece, inner, depth + 1);
    }

    void fill(WideNode& to, const Chosen& chosen, std::uint32_t first_inner, std::uint32_t& block) const
    {
        WideNode made = empty_node();
        for (unsigned i = 0; i < chosen.count; ++i) {
            const BvhNode<float>& child = node(chosen.node[i]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                made.planes[2 * axis][i] = child.lower[axis];
                made.planes[2 * axis + 1][i] = child.upper[axis];
            }
            if (child.count == 0) {
                made.child[i] = first_inner++;
                continue;
            }
            const std::uint32_t blocks = leaves_.blocks(child.count);
            made.child[i] = ChildCode::leaf(block, blocks);
            leaves_.fill(child, block);
            block += blocks;
        }
        to = made;
    }

    const Bvh<float>& bvh_;
    const LeafFiller& leaves_;
    ThreadPool& pool_;
    WideChildren children_;
    std::vector<Open> open_; // in the order of the first nodes and the pieces' roots
    Piece first_;
};

} // namespace

WideBvh widen(const Bvh<float>& bvh, const LeafFiller& leaves, ThreadPool& pool)
{
    return bvh.empty() ? WideBvh{} : Widening(bvh, leaves, pool).run();
}

} // namespace renderer
