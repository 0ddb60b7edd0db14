#include "renderer/sky/sky_cache.h"

#include <algorithm>

namespace renderer {

namespace {

AtmosphereDescription air_alone(AtmosphereDescription description)
{
    const AtmosphereDescription none;
    description.sun = none.sun;
    description.altitude_m = none.altitude_m;
    description.aerial_perspective = none.aerial_perspective;
    return description;
}

} // namespace

std::shared_ptr<const Sky> SkyCache::find(const AtmosphereDescription& air)
{
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const Entry& entry) { return entry.first == air; });
    if (found == kept_.end()) return nullptr;
    std::rotate(found, found + 1, kept_.end());
    return kept_.back().second;
}

std::shared_ptr<const Sky>
SkyCache::get(const AtmosphereDescription& description, ThreadPool& pool, const std::stop_token& stop)
{
    const AtmosphereDescription air = air_alone(description);
    {
        const std::lock_guard lock(mutex_);
        if (auto sky = find(air)) return sky;
    }
    auto made = std::make_shared<const Sky>(air, pool, stop);
    if (stop.stop_requested()) return nullptr;
    const std::lock_guard lock(mutex_);
    if (auto sky = find(air)) return sky;
    kept_.emplace_back(air, made);
    std::size_t bytes = 0;
    for (const Entry& entry : kept_)
        bytes += entry.second->size_bytes();
    while (!kept_.empty() && bytes > most_bytes_) {
        // Where all of them are too few for the new one, it is that which goes.
        const auto first = made->size_bytes() > most_bytes_ ? kept_.end() - 1 : kept_.begin();
        bytes -= first->second->size_bytes();
        kept_.erase(first);
    }
    return made;
}

} // namespace renderer
