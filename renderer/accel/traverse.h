// traverse: walks a Bvh along a ray, nearest boxes first, and hands over the leaves that the ray may touch.
//
// Cost  iterative, a fixed stack, no allocation. Boxes may be stored narrower than the ray counts.
#pragma once

#include "renderer/accel/bvh.h"
#include "renderer/geometry/box.h"

#include <utility>

namespace renderer {

// Calls leaf(first, count, end) for runs of bvh.order; it may draw `end` in as hits are found, and returns
// true to end the walk. A box that the ray enters after `end` is passed over; one entered exactly there is
// not, so that ties are seen. Children are visited in order of entry; the set of leaves that can hold a hit
// does not depend on it.
template <typename Stored, typename T, typename Leaf>
void traverse(const Bvh<Stored>& bvh, const SlabRay<T>& ray, T begin, T end, Leaf&& leaf)
{
    struct Waiting {
        const BvhNode<Stored>* node;
        T entry;
    };
    if (bvh.empty()) return;
    Waiting stack[kMaxBvhDepth];
    unsigned waiting = 0;
    const auto meets = [&](const BvhNode<Stored>& box, T& entry) {
        const Vec3<T> lower{box.lower.x, box.lower.y, box.lower.z},
            upper{box.upper.x, box.upper.y, box.upper.z};
        T exit{};
        return ray.meets(lower, upper, begin, end, entry, exit);
    };
    T root_entry{};
    if (!meets(bvh.root, root_entry)) return;
    const BvhNode<Stored>* node = &bvh.root;
    for (;;) {
        if (node->count == 0) {
            const BvhPair<Stored>& pair = bvh.pairs[node->first];
            T entry_0{}, entry_1{};
            const bool hit_0 = meets(pair.child[0], entry_0), hit_1 = meets(pair.child[1], entry_1);
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
