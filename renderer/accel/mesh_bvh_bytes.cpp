#include "renderer/accel/mesh_bvh.h"

#include <cstring>
#include <type_traits>

namespace renderer {

namespace {

struct Head {
    Bounds3f bounds, scaled_bounds;
    double blur;
    float scale;
    std::uint32_t depth;
    std::uint64_t degenerate;
};
static_assert(std::is_trivially_copyable_v<Head>);

template <typename T>
bool lend(std::span<const std::byte> bytes, const std::shared_ptr<const void>& keeper, PlainArray<T>& array)
{
    static_assert(alignof(T) <= TreeBytes::kAlignment);
    if (bytes.size() % sizeof(T) != 0) return false;
    array = PlainArray<T>::lent({reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)}, keeper);
    return true;
}

template <typename T>
std::span<const std::byte> bytes_of(const PlainArray<T>& array)
{
    return std::as_bytes(std::span(array.data(), array.size()));
}

} // namespace

TreeBytes MeshBvh::bytes() const
{
    const Head head{bounds_, bvh_.bounds, blur_, scale_, bvh_.depth, degenerate_};
    TreeBytes bytes;
    bytes.head.resize(sizeof head);
    std::memcpy(bytes.head.data(), &head, sizeof head);
    bytes.arrays = {bytes_of(bvh_.nodes), bytes_of(leaves_), bytes_of(residuals_)};
    return bytes;
}

std::optional<MeshBvh> MeshBvh::from_bytes(const TreeBytes& bytes, const std::shared_ptr<const void>& keeper)
{
    MeshBvh tree;
    Head head{};
    if (bytes.head.size() != sizeof head || bytes.arrays.size() < 3 || !keeper) return std::nullopt;
    std::memcpy(&head, bytes.head.data(), sizeof head);
    if (!lend(bytes.arrays[0], keeper, tree.bvh_.nodes) || !lend(bytes.arrays[1], keeper, tree.leaves_) ||
        !lend(bytes.arrays[2], keeper, tree.residuals_))
        return std::nullopt;
    tree.bounds_ = head.bounds;
    tree.bvh_.bounds = head.scaled_bounds;
    tree.blur_ = head.blur;
    tree.scale_ = head.scale;
    tree.bvh_.depth = head.depth;
    tree.degenerate_ = head.degenerate;
    return tree;
}

} // namespace renderer
