// BvhTopology: how a binary tree hangs together, without its boxes. When what it was built over has moved, the new boxes
// are put in (it is refitted) instead of building anew, as long as it is still a good tree for them.
//
// Good     where a ray that enters any of its boxes visits, by the surface area heuristic, few inner nodes below it more than
//          it would in a tree built anew. That is guessed from the tree as it was built: as many visits, and fewer in
//          proportion where the boxes of primitives fill less of that box than they did.
// Promise  the boxes that it was built over give the same tree again; others a tree that finds the same hits.
// Threads  immutable.
// Source   I. Wald, S. Boulos, P. Shirley, "Ray Tracing Deformable Scenes using Dynamic Bounding Volume Hierarchies", ACM
//          TOG 26(1), 2007; when to build anew: C. Lauterbach, S.-E. Yoon, D. Tuft, D. Manocha, "RT-DEFORM: Interactive Ray
//          Tracing of Dynamic Scenes using BVHs", RT 2006.
#pragma once

#include "renderer/accel/bvh.h"

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
    // than `visits_more` below some node.
    std::optional<Bvh<double>> refit(std::span<const BuildItem<double>> boxes, double visits_more) const;

    std::size_t primitives() const { return primitives_; }
    std::uint64_t size_bytes() const
    {
        return sizeof *this + pairs_.capacity() * sizeof(Pair) + order_.size_bytes();
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
        Visits as_built;
    };
    template <typename At>
    static Visits visits_of(const Bvh<double>& tree, std::size_t pair, const At& below);

    std::vector<Pair> pairs_;
    PlainArray<std::uint32_t> order_;
    Child root_{};
    unsigned depth_ = 0;
    std::size_t primitives_ = 0;
};

} // namespace renderer
