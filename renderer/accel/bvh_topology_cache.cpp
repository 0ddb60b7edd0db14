#include "renderer/accel/bvh_topology_cache.h"

#include <algorithm>
#include <utility>

namespace renderer {

namespace {

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

BvhTopologyCache::Kept::iterator BvhTopologyCache::find(const Built& built)
{
    return std::find_if(kept_.begin(), kept_.end(), [&](const Entry& entry) { return entry.built == built; });
}

std::optional<Bvh<double>> BvhTopologyCache::refit(std::span<const BuildItem<double>> boxes,
                                                   const Built& built,
                                                   double visits_more,
                                                   ThreadPool& pool)
{
    std::shared_ptr<const BvhTopology> topology;
    {
        const std::lock_guard lock(mutex_);
        const auto found = find(built);
        if (found == kept_.end()) return std::nullopt;
        topology = found->topology;
        std::rotate(found, found + 1, kept_.end());
    }
    return topology->refit(boxes, visits_more, pool);
}

void BvhTopologyCache::keep(const Bvh<double>& tree, const Built& built)
{
    if (BvhTopology::size_bytes_of(tree.pairs.size(), tree.order.size()) > most_bytes_) return;
    auto topology = std::make_shared<const BvhTopology>(tree, built.primitives);
    if (!topology->is_of_use() || topology->size_bytes() > most_bytes_) return;
    const std::lock_guard lock(mutex_);
    if (const auto found = find(built); found != kept_.end()) kept_.erase(found);
    kept_.push_back({built, std::move(topology)});
    while (kept_.size() > kMostTrees || bytes_kept() > most_bytes_)
        kept_.erase(kept_.begin());
}

} // namespace renderer
