// SkyCache: the airs that were made ready last, for the next scene under one of them. The sun, its place and the eye are
// no part of an air: a day from dawn to dusk asks for one.
//
// Threads any number at once; two that ask for the same new air may both make it, and share one afterwards.
// Memory  kept airs times what Sky takes.
#pragma once

#include "renderer/sky/sky.h"

#include <cstddef>
#include <memory>
#include <mutex>
#include <stop_token>
#include <utility>
#include <vector>

namespace renderer {

class SkyCache {
public:
    explicit SkyCache(std::size_t most = 3) : most_(most) {}

    // What `description`'s air is, from the cache or made on the pool; null only where `stop` was requested.
    std::shared_ptr<const Sky>
    get(const AtmosphereDescription& description, ThreadPool& pool, const std::stop_token& stop = {});

private:
    using Entry = std::pair<AtmosphereDescription, std::shared_ptr<const Sky>>;
    std::shared_ptr<const Sky> find(const AtmosphereDescription& air);

    std::size_t most_;
    std::mutex mutex_;
    std::vector<Entry> kept_; // the last used one at the end
};

} // namespace renderer
