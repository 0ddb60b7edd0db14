// Occluders: the leaves that hid a light from all rays of a fan. They often hide it from the next fan too, whose rays
// start beside those of the last one.
//
// A hint, no more: every way gives the same answers. Threads: each has its own.
#pragma once

#include "renderer/accel/ray_fan.h"
#include "renderer/accel/wide_bvh.h"
#include "renderer/geometry/rounding.h"
#include "renderer/math/vec3.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace renderer {

struct Occluders {
    static constexpr unsigned kMost = 4;
    unsigned count = 0;
    std::array<std::uint32_t, kMost> leaves{}; // their ChildCodes; the first `count`

    // Once each; a leaf too many is left out.
    void add(std::uint32_t leaf)
    {
        const auto end = leaves.begin() + count;
        if (count < kMost && std::find(leaves.begin(), end, leaf) == end) leaves[count++] = leaf;
    }
};

// Of the last fans to a few lights in a few meshes.
class LastOccluders {
public:
    // Of the last fan to about the same apex; none where that was not hidden. They are forgotten until they are put again.
    Occluders take(const WideNode* mesh, const RayFan& fan)
    {
        for (Known& known : known_)
            if (known.mesh == mesh &&
                max_abs(known.apex - fan.apex) <= kNear * static_cast<double>(fan.reach))
                return std::exchange(known, {}).occluders;
        return {};
    }
    void put(const WideNode* mesh, const RayFan& fan, const Occluders& occluders)
    {
        known_[next_] = {mesh, fan.apex, occluders};
        next_ = (next_ + 1) % kLights;
    }

private:
    static constexpr unsigned kLights = 4;
    static constexpr double kNear = 0x1p-12; // shadow rays end a little before their light

    struct Known {
        const WideNode* mesh = nullptr; // it may be gone, and another one be there
        Vec3d apex;
        Occluders occluders;
    };
    std::array<Known, kLights> known_;
    unsigned next_ = 0;
};

inline LastOccluders& last_occluders()
{
    static constinit thread_local LastOccluders last;
    return last;
}

} // namespace renderer
