// Moves the largest subtrees of a tree to where all boxes together become smaller: what a build from the top cannot
// see, as it never takes back a cut.
//
// Promise  the same leaves, in the same runs of `order`; depth at most kMaxBvhDepth; the same tree on any number of
//          threads.
// Needs    children's pairs behind their parents', as build_bvh and build_spatial_bvh leave them; then no longer so.
// Memory   five bytes a pair while it works.
// Cost     1 to 4 % of what building took.
// Errors   once `stop` is requested the tree is left as far as it has come.
// Source   D. Meister, J. Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", Computer
//          Graphics Forum 37(2), 2018: the search, and moves of one round that do not meet.
#pragma once

#include "renderer/accel/bvh.h"

namespace renderer {

void reinsert_largest(Bvh<float>& tree, ThreadPool& pool, const std::stop_token& stop = {});

} // namespace renderer
