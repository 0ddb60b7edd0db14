// BvhTopology: how a binary tree hangs together, without its boxes. When what it was built over has moved, the new boxes
// are put in (it is refitted) instead of building anew, as long as it is still a good tree for them.
//
// Good     where a ray that enters any of its boxes visits, by the surface area heuristic, few inner nodes below it more than
//          it would in a tree built anew. That is guessed from the tree as it was built: as many visits, and fewer in
//          proportion where the boxes of primitives fill less of that box than they did; but never more than there are in
//          trees over scattered primitives. So no refitted tree is worse than that by much, whatever it was built over, not even
//          over boxes that somebody thought out to have a bad tree kept.
// Promise  the boxes that it was built over give the same tree again, unless no good one can be built over them, or they have
//          no area; all others a tree that finds the same hits.
// Threads  immutable. The pool's threads share the work.
// Cost     on one thread 30 to 60 ns a primitive, 1/22 to 1/14 of building it; 36 bytes each.
// Source   I. Wald, S. Boulos, P. Shirley, "Ray Tracing Deformable Scenes using Dynamic Bounding Volume Hierarchies", ACM
//          TOG 26(1), 2007; when to build anew: C. Lauterbach, S.-E. Yoon, D. Tuft, D. Manocha, "RT-DEFORM: Interactive Ray
//          Tracing of Dynamic Scenes using BVHs", RT 2006.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/parallel/thread_pool.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace renderer {

class BvhTopology {
public:
    // `tree` as build_bvh made it over those of `primitives` primitives that have boxes.
    BvhTopology(const Bvh<double>& tree, std::size_t primitives);

    // boxes[p] is that of primitive p, or empty. Nothing where others have boxes than had, or a ray would visit more
    // than `visits_more` too many below some node.
    std::optional<Bvh<double>>
    refit(std::span<const BuildItem<double>> boxes, double visits_more, ThreadPool& pool) const;

    std::size_t primitives() const { return primitives_; }
    // Whether any boxes could do: false where there were no pairs, or areas are no numbers.
    bool is_of_use() const;
    std::uint64_t size_bytes() const
    {
        return size_bytes_of(pairs_.size(), order_.size()) + pieces_.capacity() * sizeof(Piece) +
               above_.capacity() * sizeof(std::uint32_t);
    }
    static std::uint64_t size_bytes_of(std::size_t pairs, std::size_t primitives)
    {
        return sizeof(BvhTopology) + pairs * sizeof(Pair) + primitives * sizeof(std::uint32_t);
    }

private:
    struct Child {
        std::uint32_t first, count; // as in BvhNode
    };
    // Of a ray that enters the box around a pair: the inner nodes that it visits from there, this one counted, and the
    // leaves that it enters, on average.
    struct Visits {
        double inner = 0, leaves = 0;
    };
    struct Pair {
        Child child[2];
        Visits as_built; // or fewer, see above
    };
    // A subtree whose pairs stand side by side: one thread's share.
    struct Piece {
        std::uint32_t begin, end;
    };
    class Refit;
    template <typename At>
    static Visits visits_of(const Bvh<double>& tree, std::size_t pair, const At& below);
    void cut_in_pieces();

    std::vector<Pair> pairs_;
    PlainArray<std::uint32_t> order_;
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> above_; // pairs of no piece, from the top
    Child root_{};
    unsigned depth_ = 0;
    std::size_t primitives_ = 0;
};

} // namespace renderer
