// Which nodes of a binary tree become the children of wide ones: of all ways to leave nodes out, the one by which
// the areas of the wide inner nodes come to the least, so that a ray visits the fewest.
//
// Memory   32 bytes a pair.
// Source   H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//          BVHs", HPG 2017: the dynamic program; here without merging leaves.
#pragma once

#include "renderer/accel/wide_bvh.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace renderer {

class WideChildren {
public:
    static constexpr std::size_t kPieces = 256; // subtrees that threads share, where there are so many

    // Not empty. The same choice on any number of threads.
    WideChildren(const Bvh<float>& bvh, ThreadPool& pool);

    struct Chosen {
        std::array<std::uint32_t, WideNode::kChildren> node; // the first `count`, by number
        unsigned count = 0;
    };
    // Of an inner node, or of a root that is a leaf: itself.
    Chosen of(std::uint32_t number) const;

private:
    // Of what lies below a pair: the areas of all wide inner nodes there, where up to i + 1 of its nodes may be
    // children of one above.
    struct Costs {
        float with[WideNode::kChildren];
    };
    float cost(std::uint32_t number, unsigned places) const;
    float cost_of_parting(std::uint32_t pair, unsigned places, unsigned left) const;
    void add_up(std::uint32_t number);
    void add_up_pair(std::uint32_t number);
    void choose(std::uint32_t number, unsigned places, Chosen& out) const;
    void part(std::uint32_t pair, unsigned places, Chosen& out) const;

    const Bvh<float>& bvh_;
    PlainArray<Costs> costs_;
};

} // namespace renderer
