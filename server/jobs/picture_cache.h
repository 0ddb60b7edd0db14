// PictureCache: the pictures that were made or read last, by digest, up to a number of bytes.
//
// Threads  every function may be called from any thread.
#pragma once

#include "server/jobs/live_jobs.h"

#include <cstddef>
#include <list>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

namespace server {

class PictureCache {
public:
    explicit PictureCache(std::size_t bytes) : room_(bytes) {}

    PngBytes find(const std::string& digest); // nothing if it is not here
    void put(const std::string& digest, PngBytes png);

private:
    std::mutex mutex_;
    std::size_t room_;
    std::size_t used_ = 0;
    std::list<std::pair<std::string, PngBytes>> recent_; // last used first
    std::unordered_map<std::string, std::list<std::pair<std::string, PngBytes>>::iterator> by_digest_;
};

} // namespace server
