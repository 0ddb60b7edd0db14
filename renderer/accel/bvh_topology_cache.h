// BvhTopologyCache: the trees that were built last over the objects of scenes, without their boxes, for the next frame of
// an animation: one scene after another, in which the camera or some objects have moved.
//
// Threads  any number at once.
// Memory   as many bytes as it is made for: what was used the longest ago goes first.
// Cost     a frame whose tree must be built anew has tried two earlier ones at most, a twentieth of building each.
#pragma once

#include "renderer/accel/bvh_topology.h"

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace renderer {

class BvhTopologyCache {
public:
    static constexpr std::size_t kUsualBytes = 16 << 20; // of 400,000 objects
    explicit BvhTopologyCache(std::size_t most_bytes = kUsualBytes) : most_bytes_(most_bytes) {}

    // See BvhTopology::refit.
    std::optional<Bvh<double>>
    refit(std::span<const BuildItem<double>> boxes, BvhSplit split, double visits_more);
    // Of a tree built with `split`, over those of `primitives` that have boxes.
    void keep(const Bvh<double>& tree, std::size_t primitives, BvhSplit split);

    std::uint64_t size_bytes() const;

private:
    struct Entry {
        BvhSplit split;
        std::shared_ptr<const BvhTopology> topology;
    };
    std::uint64_t bytes_kept() const;

    std::size_t most_bytes_;
    mutable std::mutex mutex_;
    std::vector<Entry> kept_; // the last used one at the end
};

} // namespace renderer
