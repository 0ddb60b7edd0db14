// PictureCache: the pictures that were made, encoded or read last, by blob and encoding, up to a number of bytes.
//
// Threads  every function may be called from any thread.
#pragma once

#include "renderer/description/layers.h"
#include "renderer/description/picture_formats.h"
#include "server/jobs/live_jobs.h"

#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

namespace server {

// Bytes as they are sent, and their own digest.
struct EncodedPicture {
    PictureBytes bytes;
    std::string digest; // "sha256:..."
};

// Of the picture in one blob, or of a layer beside it.
std::string picture_key(const std::string& image_digest,
                        const renderer::PictureEncoding& encoding,
                        std::optional<renderer::Layer> layer = {});

class PictureCache {
public:
    explicit PictureCache(std::size_t bytes) : room_(bytes) {}

    std::optional<EncodedPicture> find(const std::string& key);
    void put(const std::string& key, EncodedPicture picture);

private:
    using Recent = std::list<std::pair<std::string, EncodedPicture>>;

    std::mutex mutex_;
    std::size_t room_;
    std::size_t used_ = 0;
    Recent recent_; // last used first
    std::unordered_map<std::string, Recent::iterator> by_key_;
};

} // namespace server
