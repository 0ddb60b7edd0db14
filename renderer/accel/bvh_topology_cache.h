// BvhTopologyCache: the trees that were built last over the objects of scenes, without their boxes, for the next frame of
// an animation: one scene after another, in which the camera or some objects have moved.
//
// Threads  any number at once.
// Memory   as many bytes as it is made for: what was used the longest ago goes first. Of trees that were built alike, the last.
// Cost     a frame whose tree must be built anew has tried one earlier one at most, and leaves its own: a tenth of building.
#pragma once

#include "renderer/accel/bvh_topology.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace renderer {

class BvhTopologyCache {
public:
    static constexpr std::size_t kUsualBytes = 16 << 20; // of 450,000 objects
    explicit BvhTopologyCache(std::size_t most_bytes = kUsualBytes) : most_bytes_(most_bytes) {}

    // Two trees were built alike where these are the same: frames of one animation, most likely.
    struct Built {
        BvhSplit split;
        std::size_t primitives;  // with boxes and without
        std::uint64_t kinds = 0; // a number that tells most lists of what primitives are apart

        friend bool operator==(const Built&, const Built&) = default;
    };
    // See BvhTopology::refit.
    std::optional<Bvh<double>>
    refit(std::span<const BuildItem<double>> boxes, const Built& built, double visits_more, ThreadPool& pool);
    void keep(const Bvh<double>& tree, const Built& built);

    std::uint64_t size_bytes() const;

private:
    struct Entry {
        Built built;
        std::shared_ptr<const BvhTopology> topology;
    };
    using Kept = std::vector<Entry>;
    Kept::iterator find(const Built& built);
    std::uint64_t bytes_kept() const;

    std::size_t most_bytes_;
    mutable std::mutex mutex_;
    Kept kept_; // the last used one at the end
};

} // namespace renderer
