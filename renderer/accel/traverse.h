// traverse: walks a Bvh along a ray, nearest boxes first, and hands over the leaves that the ray may touch.
//
// Cost  iterative, a fixed stack, no allocation.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/geometry/box.h"

#include <utility>

namespace renderer {

// Calls leaf(first, count, end) for runs of bvh.order; it may draw `end` in as hits are found, and returns
// true to end the walk. A box that the ray enters after `end` is passed over; one entered exactly there is
// not, so that ties are seen. Children are visited in order of entry; the set of leaves that can hold a hit
// does not depend on it.
template <typename T, typename Leaf>
void traverse(const Bvh<T>& bvh, const SlabRay<T>& ray, T begin, T end, Leaf&& leaf)
{
    struct Waiting {
        const BvhNode<T>* node;
        T entry;
    };
    if (bvh.empty()) return;
    Waiting stack[kMaxBvhDepth];
    unsigned waiting = 0;
    T entry{}, exit{};
    if (!ray.meets(bvh.root.lower, bvh.root.upper, begin, end, entry, exit)) return;
    const BvhNode<T>* node = &bvh.root;
    for (;;) {
        if (node->count == 0) {
            const BvhPair<T>& pair = bvh.pairs[node->first];
            T entry_0{}, entry_1{};
            const bool hit_0 = ray.meets(pair.child[0].lower, pair.child[0].upper, begin, end, entry_0, exit);
            const bool hit_1 = ray.meets(pair.child[1].lower, pair.child[1].upper, begin, end, entry_1, exit);
            if (hit_0 && hit_1) {
                const unsigned nearer = entry_1 < entry_0 ? 1 : 0;
                stack[waiting++] = {&pair.child[1 - nearer], nearer == 1 ? entry_0 : entry_1};
                node = &pair.child[nearer];
                continue;
            }
            if (hit_0 || hit_1) {
                node = &pair.child[hit_0 ? 0 : 1];
                continue;
            }
        } else if (leaf(node->first, node->count, end)) {
            return;
        }
        do {
            if (waiting == 0) return;
            --waiting;
        } while (stack[waiting].entry > end);
        node = stack[waiting].node;
    }
}

} // namespace renderer
