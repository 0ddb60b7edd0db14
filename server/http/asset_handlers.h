// AssetHandlers: /v1/assets: upload, download and what is in an asset.
#pragma once

#include "renderer/description/limits.h"
#include "server/http/router.h"
#include "server/http/waiters.h"
#include "server/import/import_service.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <optional>
#include <string>

namespace server {

class AssetHandlers {
public:
    AssetHandlers(Store& store,
                  BlobStore& blobs,
                  ImportService& imports,
                  const renderer::Limits& limits,
                  Waiters& waiters)
        : store_(store), blobs_(blobs), imports_(imports), limits_(limits), waiters_(waiters)
    {
    }

    void add_routes(Router& router);

private:
    void put(Exchange& exchange);
    void post(Exchange& exchange);
    void get(Exchange& exchange);
    void info(Exchange& exchange);
    void store_body(Exchange& exchange, const std::string& announced);
    // Imports while the client is there; nothing if it left or the server stops.
    std::optional<api::AssetInfo> import_while_wanted(Exchange& exchange, const std::string& digest);

    Store& store_;
    BlobStore& blobs_;
    ImportService& imports_;
    const renderer::Limits& limits_;
    Waiters& waiters_;
};

} // namespace server
