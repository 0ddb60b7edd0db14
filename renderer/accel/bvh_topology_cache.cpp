#include "renderer/accel/bvh_topology_cache.h"

#include <algorithm>
#include <utility>

namespace renderer {

namespace {

constexpr std::size_t kMostTries = 2;
constexpr std::size_t kMostTrees = 64; // they are looked through one by one

} // namespace

std::uint64_t BvhTopologyCache::bytes_kept() const
{
    std::uint64_t bytes = 0;
    for (const Entry& entry : kept_)
        bytes += entry.topology->size_bytes();
    return bytes;
}

std::uint64_t BvhTopologyCache::size_bytes() const
{
    const std::lock_guard lock(mutex_);
    return bytes_kept();
}

std::optional<Bvh<double>>
BvhTopologyCache::refit(std::span<const BuildItem<double>> boxes, BvhSplit split, double visits_more)
{
    std::vector<std::shared_ptr<const BvhTopology>> tried;
    {
        const std::lock_guard lock(mutex_);
        for (auto entry = kept_.rbegin(); entry != kept_.rend() && tried.size() < kMostTries; ++entry)
            if (entry->split == split && entry->topology->primitives() == boxes.size())
                tried.push_back(entry->topology);
    }
    for (const auto& topology : tried) {
        std::optional<Bvh<double>> tree = topology->refit(boxes, visits_more);
        if (!tree) continue;
        const std::lock_guard lock(mutex_);
        const auto found = std::find_if(
            kept_.begin(), kept_.end(), [&](const Entry& entry) { return entry.topology == topology; });
        if (found != kept_.end()) std::rotate(found, found + 1, kept_.end());
        return tree;
    }
    return std::nullopt;
}

void BvhTopologyCache::keep(const Bvh<double>& tree, std::size_t primitives, BvhSplit split)
{
    auto topology = std::make_shared<const BvhTopology>(tree, primitives);
    if (topology->size_bytes() > most_bytes_) return;
    const std::lock_guard lock(mutex_);
    kept_.push_back({split, std::move(topology)});
    while (kept_.size() > kMostTrees || bytes_kept() > most_bytes_)
        kept_.erase(kept_.begin());
}

} // namespace renderer
