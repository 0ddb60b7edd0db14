#include "server/http/asset_intake.h"

#include "api/words/limit_words.h"
#include "server/http/exchange.h"

#include <span>

namespace server {

AssetIntake::AssetIntake(Store& store, BlobStore& blobs, const renderer::Limits& limits, bool durable)
    : store_(store), blobs_(blobs), limits_(limits), writer_(blobs.write(BlobStore::Kind::asset, durable))
{
}

bool AssetIntake::append(std::string_view bytes)
{
    over_limit_ = over_limit_ || bytes.size() > limits_.asset_bytes - writer_->bytes();
    if (!over_limit_) writer_->append(std::as_bytes(std::span(bytes)));
    return !over_limit_;
}

std::variant<StoredAsset, api::ProblemDetails> AssetIntake::commit(const std::string& announced)
{
    const std::uint64_t bytes = writer_->bytes();
    const std::string digest = writer_->digest();
    if (!announced.empty() && digest != announced)
        return problem(422,
                       "digest_mismatch",
                       "the path names " + announced + ", but the " + std::to_string(bytes) +
                           " bytes that came have " + digest);
    if (!blobs_.has(BlobStore::Kind::asset, digest) &&
        !blobs_.make_room(bytes, limits_.total_asset_bytes, [&] { return store_.assets_in_use(); }))
        return problem(503,
                       "storage_full",
                       "all assets together would be over the limit total_asset_bytes, " +
                           std::to_string(limits_.total_asset_bytes) +
                           " bytes, and those stored are in use; the service's flag " +
                           api::flag_of("total_asset_bytes") + " raises it");
    return StoredAsset{digest, bytes, writer_->commit()};
}

} // namespace server
