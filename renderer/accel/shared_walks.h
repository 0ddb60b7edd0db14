// SharedWalks: whether one walk for many rays has paid lately in a mesh. Among triangles far smaller than the rays stand apart
// it does not, and which meshes are looked at so is known only when they are.
//
// A hint, no more: every way gives the same hits. Threads: any number at once; an update may be lost.
#pragma once

#include "renderer/geometry/ray.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>

namespace renderer {

class SharedWalks {
public:
    // Where they have not paid, one time in sixteen, picked by the ray's digits: a view may change.
    [[nodiscard]] bool worth_trying(const Ray& first) const
    {
        if (std::atomic_ref(lost_).load(std::memory_order_relaxed) < kMany) return true;
        return std::bit_cast<std::uint64_t>(first.direction.x) * 0x9E3779B97F4A7C15u >> 60 == 0;
    }
    void tell(bool paid)
    {
        const std::atomic_ref lost(lost_);
        const std::uint32_t before = lost.load(std::memory_order_relaxed);
        const std::uint32_t after = paid ? before - std::min(before, kPaid) : std::min(before + 1, kMost);
        if (after != before)
            lost.store(after, std::memory_order_relaxed); // no line is taken from others in vain
    }

private:
    // One that paid makes up for four that did not: where a fifth of them pay, they are all tried.
    static constexpr std::uint32_t kPaid = 4, kMany = 128, kMost = 160;

    alignas(std::atomic_ref<std::uint32_t>::required_alignment) mutable std::uint32_t lost_ = 0;
};

// Of a mesh: of fans and of beams, each for nearest hits [0] and any [1].
struct alignas(64) MeshWalks {
    SharedWalks fans[2], beams[2];
};

} // namespace renderer
