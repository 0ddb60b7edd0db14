// SkyCache: the airs that were made ready last, for the next scene under one of them. The sun, its place and the eye are
// no part of an air: a day from dawn to dusk asks for one.
//
// Threads any number at once; two that ask for the same new air may both make it, and share one afterwards.
// Memory  as many bytes of tables as it is made for: what was used the longest ago goes first, and an air that is larger
//         than all of them is not kept.
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
    static constexpr std::size_t kUsualBytes = 64 << 20; // two airs of three wavelengths in mode exact
    explicit SkyCache(std::size_t most_bytes = kUsualBytes) : most_bytes_(most_bytes) {}

    // What `description`'s air is, from the cache or made on the pool; null only where `stop` was requested.
    std::shared_ptr<const Sky>
    get(const AtmosphereDescription& description, ThreadPool& pool, const std::stop_token& stop = {});

private:
    using Entry = std::pair<AtmosphereDescription, std::shared_ptr<const Sky>>;
    std::shared_ptr<const Sky> find(const AtmosphereDescription& air);

    std::size_t most_bytes_;
    std::mutex mutex_;
    std::vector<Entry> kept_; // the last used one at the end
};

} // namespace renderer
