// AssetHandlers: /v1/assets: upload, download and what is in an asset.
#pragma once

#include "renderer/description/limits.h"
#include "server/http/router.h"
#include "server/import/import_service.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

namespace server {

class AssetHandlers {
public:
    AssetHandlers(Store& store, BlobStore& blobs, ImportService& imports, const renderer::Limits& limits)
        : store_(store), blobs_(blobs), imports_(imports), limits_(limits)
    {
    }

    void add_routes(Router& router);

private:
    void put(Exchange& exchange);
    void post(Exchange& exchange);
    void get(Exchange& exchange);
    void info(Exchange& exchange);
    void store_body(Exchange& exchange, const std::string& announced);

    Store& store_;
    BlobStore& blobs_;
    ImportService& imports_;
    const renderer::Limits& limits_;
};

} // namespace server
