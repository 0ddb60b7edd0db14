// DamagedBlob: a blob whose bytes on disk are not those of its name. It counts as missing from then on, so that
// uploading it again mends it.
#pragma once

#include "server/store/store.h"

#include <filesystem>
#include <string>
#include <utility>

namespace server {

struct DamagedBlob : StoreError {
    std::string digest;
    bool asset = false; // that a client can upload again; else a result

    DamagedBlob(std::string blob, bool is_asset, const std::filesystem::path& file)
        : StoreError(std::string(is_asset ? "asset " : "result ") + blob + " is damaged on disk (" +
                         file.string() + "): its bytes are not those of its digest",
                     false),
          digest(std::move(blob)), asset(is_asset)
    {
    }
};

} // namespace server
