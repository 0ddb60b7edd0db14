#include "renderer/accel/wide_bvh.h"

#include <limits>

namespace renderer::wide {

namespace {

double half_area(const BvhNode<float>& node)
{
    const Vec3d e = to_double(node.upper) - to_double(node.lower);
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

} // namespace

Children children_of(const Bvh<float>& bvh, const BvhNode<float>& node)
{
    Children open;
    if (node.count != 0) { // the whole tree is one leaf
        open.node[open.count++] = node;
        return open;
    }
    for (const BvhNode<float>& child : bvh.pairs[node.first].child)
        open.node[open.count++] = child;
    while (open.count < WideNode::kChildren) {
        unsigned largest = open.count;
        double area = -1;
        for (unsigned i = 0; i < open.count; ++i)
            if (open.node[i].count == 0 && half_area(open.node[i]) > area) {
                largest = i;
                area = half_area(open.node[i]);
            }
        if (largest == open.count) break; // leaves only
        const BvhPair<float>& pair = bvh.pairs[open.node[largest].first];
        open.node[largest] = pair.child[0];
        open.node[open.count++] = pair.child[1];
    }
    return open;
}

WideNode empty_node()
{
    WideNode node{};
    for (std::size_t row = 0; row < 6; ++row)
        for (float& plane : node.planes[row])
            plane = row % 2 == 0 ? std::numeric_limits<float>::infinity()
                                 : -std::numeric_limits<float>::infinity();
    return node;
}

void set_box(WideNode& node, unsigned slot, const BvhNode<float>& box)
{
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[2 * axis][slot] = box.lower[axis];
        node.planes[2 * axis + 1][slot] = box.upper[axis];
    }
}

} // namespace renderer::wide
