#include "server/http/asset_handlers.h"

#include "api/job_view.h"
#include "server/http/asset_intake.h"
#include "server/http/body.h"
#include "server/http/guard/guarded_server.h"
#include "server/http/printable.h"

#include <future>
#include <memory>
#include <stop_token>

namespace server {

namespace {

constexpr BlobStore::Kind kAsset = BlobStore::Kind::asset;

api::ProblemDetails no_such_asset(const std::string& digest)
{
    if (!is_digest(digest))
        return problem(404,
                       "not_found",
                       std::string("\"") + printable(digest) +
                           "\" is no digest: sha256: and 64 hex digits in lower case");
    return problem(404, "not_found", digest + " is not here: PUT /v1/assets/" + digest + " uploads it");
}

} // namespace

void AssetHandlers::add_routes(Router& router)
{
    router.add({"POST", "/v1/assets", {}, [this](Exchange& exchange) { post(exchange); }});
    router.add({"PUT", "/v1/assets/{digest}", {}, [this](Exchange& exchange) { put(exchange); }});
    router.add({"GET", "/v1/assets/{digest}", {}, [this](Exchange& exchange) { get(exchange); }});
    router.add({"GET", "/v1/assets/{digest}/info", {}, [this](Exchange& exchange) { info(exchange); }});
}

void AssetHandlers::put(Exchange& exchange)
{
    const std::string& digest = exchange.path.at("digest");
    if (!is_digest(digest))
        return reply_problem(
            exchange,
            problem(422,
                    "invalid_digest",
                    "the path must end in sha256: and 64 hex digits in lower case, as sha256sum writes them; "
                    "POST /v1/assets takes bytes whose digest is not known"));
    store_body(exchange, digest);
}

void AssetHandlers::post(Exchange& exchange)
{
    store_body(exchange, {});
}

void AssetHandlers::store_body(Exchange& exchange, const std::string& announced)
{
    if (exchange.header(kBodyType).rfind("multipart/", 0) == 0)
        return reply_problem(
            exchange,
            problem(
                415,
                "unsupported_media_type",
                "an asset's body is its bytes and nothing else: curl -T FILE, or curl --data-binary @FILE"));
    if (auto refusal = refuse_by_head(exchange, "the asset", "asset_bytes", limits_))
        return reply_problem(exchange, *std::move(refusal));
    AssetIntake intake(store_, blobs_, limits_);
    auto failure = read_body(exchange, [&](std::string_view bytes) { return intake.append(bytes); });
    if (failure) return reply_problem(exchange, *std::move(failure));
    if (intake.over_limit()) return reply_problem(exchange, over_limit("the asset", "asset_bytes", limits_));
    if (announced.empty() && intake.bytes() == 0)
        return reply_problem(
            exchange, problem(422, "empty_body", "the body is empty: curl --data-binary @FILE sends a file"));
    auto stored = intake.commit(announced);
    if (auto* refusal = std::get_if<api::ProblemDetails>(&stored))
        return reply_problem(exchange, std::move(*refusal), 60);
    const auto& asset = std::get<StoredAsset>(stored);
    exchange.response.set_header("Location", "/v1/assets/" + asset.digest);
    reply_json(exchange, asset.fresh ? 201 : 200, api::write_asset(asset.digest, asset.bytes));
}

void AssetHandlers::get(Exchange& exchange)
{
    const std::string& digest = exchange.path.at("digest");
    if (!is_digest(digest)) return reply_problem(exchange, no_such_asset(digest));
    Payload payload{.digest = digest, .content_type = "application/octet-stream"};
    if (exchange.request.method == "HEAD") {
        const auto size = blobs_.size(kAsset, digest);
        if (!size) return reply_problem(exchange, no_such_asset(digest));
        payload.size = *size;
        blobs_.touch(kAsset, digest);
    } else {
        const std::shared_ptr<BlobReader> reader = blobs_.open(kAsset, digest);
        if (!reader) return reply_problem(exchange, no_such_asset(digest));
        payload.size = reader->size();
        payload.source = [reader](std::uint64_t offset) { return reader->at(offset); };
        payload.let_go = [reader] { reader->let_go(); };
    }
    exchange.response.set_header("Cache-Control", "private, immutable");
    exchange.response.set_header("Content-Disposition", "attachment");
    reply_payload(exchange, payload);
}

void AssetHandlers::info(Exchange& exchange)
{
    const std::string& digest = exchange.path.at("digest");
    if (!is_digest(digest) || !blobs_.has(kAsset, digest))
        return reply_problem(exchange, no_such_asset(digest));
    blobs_.touch(kAsset, digest);
    auto info = imports_.known_info(digest);
    if (!info) {
        const auto place = waiters_.enter(); // an import takes its time, and this thread with it
        if (!place) return reply_problem(exchange, too_many_waiters(limits_));
        info = import_while_wanted(exchange, digest);
    }
    if (!info)
        return reply_problem(exchange,
                             problem(503, "draining", "the service stops: ask again when it is back"));
    reply_json(exchange, 200, api::write_asset_info(*info));
}

std::optional<api::AssetInfo> AssetHandlers::import_while_wanted(Exchange& exchange,
                                                                 const std::string& digest)
{
    std::stop_source stop;
    auto imported = std::async(std::launch::async, [&] { return imports_.info(digest, stop.get_token()); });
    while (imported.wait_for(kGlance) != std::future_status::ready)
        if (!exchange.still_wanted()) stop.request_stop();
    return imported.get();
}

} // namespace server
