// AssetIntake: bytes of a request on their way to becoming an asset: counted against the limits, stored by
// content.
//
// Errors  the client's (over a limit, another digest than announced) are values; StoreError is the world's.
#pragma once

#include "api/problem.h"
#include "renderer/description/limits.h"
#include "server/store/blob_store.h"
#include "server/store/store.h"

#include <memory>
#include <string>
#include <string_view>
#include <variant>

namespace server {

struct StoredAsset {
    std::string digest;
    std::uint64_t bytes = 0;
    bool fresh = false; // it was not there before
};

class AssetIntake {
public:
    // `durable` false: the caller makes it so, for many together.
    AssetIntake(Store& store, BlobStore& blobs, const renderer::Limits& limits, bool durable = true);

    // False when it is over limits.asset_bytes.
    bool append(std::string_view bytes);
    bool over_limit() const { return over_limit_; }
    std::uint64_t bytes() const { return writer_->bytes(); }
    // `announced` empty: any digest is right. 422 digest_mismatch, 503 storage_full.
    std::variant<StoredAsset, api::ProblemDetails> commit(const std::string& announced = {});

private:
    Store& store_;
    BlobStore& blobs_;
    const renderer::Limits& limits_;
    std::unique_ptr<BlobStore::Writer> writer_;
    bool over_limit_ = false;
};

} // namespace server
