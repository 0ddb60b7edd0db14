// SharedWalks: whether one walk for many rays through a point has paid lately in a mesh. Among triangles far smaller
// than the rays stand apart it does not, and which meshes are looked at so is known only when they are.
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
    // What a walk that was lost weighs, and one that paid: where more are lost than these make up for, no more are
    // tried.
    constexpr SharedWalks(std::uint32_t lost, std::uint32_t paid) : lost_weight_(lost), paid_weight_(paid) {}

    // Where they have not paid, one time in sixteen, picked by the ray's digits: a view may change.
    [[nodiscard]] bool worth_trying(const Ray& first) const
    {
        if (std::atomic_ref(balance_).load(std::memory_order_relaxed) < kMany) return true;
        return std::bit_cast<std::uint64_t>(first.direction.x) * 0x9E3779B97F4A7C15u >> 60 == 0;
    }
    void tell(bool paid)
    {
        const std::atomic_ref balance(balance_);
        const std::uint32_t before = balance.load(std::memory_order_relaxed);
        const std::uint32_t after =
            paid ? before - std::min(before, paid_weight_) : std::min(before + lost_weight_, kMost);
        if (after != before)
            balance.store(after, std::memory_order_relaxed); // no line is taken from others in vain
    }

private:
    // Very many in a row: hard corners lie together in meshes where most walks pay.
    static constexpr std::uint32_t kMany = 4096, kMost = 5120;

    std::uint32_t lost_weight_, paid_weight_;
    alignas(std::atomic_ref<std::uint32_t>::required_alignment) mutable std::uint32_t balance_ = 0;
};

// Of the fans in a mesh, for the nearest hit and for any. A lost fan has found nothing of the nearest hits, and of any
// hits some: these are worth trying where half of them pay, those where two thirds do.
struct alignas(64) FanWalks {
    SharedWalks nearest{32, 16}, any{1, 1};

    SharedWalks& of(bool any_hit) { return any_hit ? any : nearest; }
};

} // namespace renderer
