#include "server/jobs/picture_cache.h"

namespace server {

std::string picture_key(const std::string& image_digest,
                        const renderer::PictureEncoding& encoding,
                        std::optional<renderer::Layer> layer)
{
    const std::string of = layer ? "/" + std::string(entry_of(*layer).name) : std::string();
    return image_digest + of + std::string(entry_of(encoding.format).extension) +
           std::to_string(encoding.bits);
}

std::optional<EncodedPicture> PictureCache::find(const std::string& key)
{
    const std::lock_guard lock(mutex_);
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return std::nullopt;
    recent_.splice(recent_.begin(), recent_, found->second);
    return found->second->second;
}

void PictureCache::put(const std::string& key, EncodedPicture picture)
{
    const std::lock_guard lock(mutex_);
    if (!picture.bytes || picture.bytes->size() > room_ || by_key_.contains(key)) return;
    used_ += picture.bytes->size();
    recent_.emplace_front(key, std::move(picture));
    by_key_[key] = recent_.begin();
    while (used_ > room_) {
        used_ -= recent_.back().second.bytes->size();
        by_key_.erase(recent_.back().first);
        recent_.pop_back();
    }
}

} // namespace server
