#include "server/jobs/picture_cache.h"

namespace server {

PngBytes PictureCache::find(const std::string& digest)
{
    const std::lock_guard lock(mutex_);
    const auto found = by_digest_.find(digest);
    if (found == by_digest_.end()) return nullptr;
    recent_.splice(recent_.begin(), recent_, found->second);
    return found->second->second;
}

void PictureCache::put(const std::string& digest, PngBytes png)
{
    const std::lock_guard lock(mutex_);
    if (!png || png->size() > room_ || by_digest_.contains(digest)) return;
    used_ += png->size();
    recent_.emplace_front(digest, std::move(png));
    by_digest_[digest] = recent_.begin();
    while (used_ > room_) {
        used_ -= recent_.back().second->size();
        by_digest_.erase(recent_.back().first);
        recent_.pop_back();
    }
}

} // namespace server
