#include "server/jobs/stored_pictures.h"

#include "renderer/film/encode_layer.h"
#include "renderer/film/encode_picture.h"
#include "server/jobs/job_problems.h"
#include "server/jobs/kept_picture.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace server {

namespace {

bool is_kept_as_sent(const renderer::PictureEncoding& encoding, std::optional<renderer::Layer> layer)
{
    return !layer && encoding == renderer::PictureEncoding{};
}

EncodedPicture named(std::vector<std::byte> bytes)
{
    EncodedPicture picture{std::make_shared<const std::vector<std::byte>>(std::move(bytes)), {}};
    picture.digest = digest_of(std::span<const std::byte>(*picture.bytes));
    return picture;
}

std::vector<std::uint8_t> encode_layer(const renderer::Picture& picture,
                                       renderer::Layer layer,
                                       const renderer::PictureEncoding& encoding)
{
    for (const renderer::LayerImage& image : picture.layers)
        if (image.layer == layer) return renderer::encode_layer(picture, image, encoding);
    throw StoreError("a kept picture lacks a layer that its job asked for", false);
}

// Of a picture that was kept.
StoredPictures::Answer encode(const JobId& id,
                              std::span<const std::byte> blob,
                              const renderer::PictureEncoding& encoding,
                              std::optional<renderer::Layer> layer)
{
    if (is_kept_as_sent(encoding, layer)) {
        const auto png = png_of(blob);
        return named({png.begin(), png.end()});
    }
    const std::optional<renderer::Picture> picture = unpack_picture(blob);
    if (!picture) return png_alone_problem(id);
    const std::uint32_t most = entry_of(encoding.format).most_side_px;
    if (std::max(picture->image.width_px, picture->image.height_px) > most)
        return format_too_small_problem(encoding.format);
    const std::vector<std::uint8_t> bytes =
        layer ? encode_layer(*picture, *layer, encoding) : renderer::encode_picture(*picture, encoding);
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    return named({first, first + bytes.size()});
}

} // namespace

StoredPictures::Answer StoredPictures::get(const JobId& id,
                                           const std::string& digest,
                                           const PictureBytes& kept,
                                           const renderer::PictureEncoding& encoding,
                                           std::optional<renderer::Layer> layer)
{
    const std::string key = picture_key(digest, encoding, layer);
    if (auto cached = rooms_.pictures.find(key)) return *std::move(cached);
    std::optional<EncodingTurns::Turn> turn;
    if (!is_kept_as_sent(encoding, layer)) {
        turn.emplace(turns_, key);
        if (auto cached = rooms_.pictures.find(key)) return *std::move(cached); // while this waited
    }
    PictureBytes bytes = kept;
    if (!bytes) {
        auto found = blob(id, digest);
        if (auto* problem = std::get_if<api::ProblemDetails>(&found)) return std::move(*problem);
        bytes = std::move(std::get<PictureBytes>(found));
    }
    Answer answer = encode(id, *bytes, encoding, layer);
    if (const auto* picture = std::get_if<EncodedPicture>(&answer)) rooms_.pictures.put(key, *picture);
    return answer;
}

std::variant<PictureBytes, api::ProblemDetails> StoredPictures::blob(const JobId& id,
                                                                     const std::string& digest)
{
    std::string why_not;
    PictureBytes bytes = read(digest, why_not);
    if (bytes) return bytes;
    // While this is held no picture comes or goes: what is lost now is lost.
    const auto hold = rooms_.keeper.hold_results();
    bytes = read(digest, why_not);
    if (bytes) return bytes;
    return render_again(id, digest, why_not);
}

PictureBytes StoredPictures::read(const std::string& digest, std::string& why_not)
{
    try {
        if (auto bytes = rooms_.blobs.read(BlobStore::Kind::result, digest))
            return std::make_shared<const std::vector<std::byte>>(*std::move(bytes));
        why_not = "result " + digest + " is not there";
    } catch (const StoreError& error) {
        if (rooms_.blobs.has(BlobStore::Kind::result, digest)) throw; // out of files, say: nothing is lost
        why_not = error.what();
    }
    return nullptr;
}

api::ProblemDetails
StoredPictures::render_again(const JobId& id, const std::string& digest, const std::string& why)
{
    // Its row is there, its entry not yet gone: ask again in a moment.
    if (rooms_.live.snapshot(id).job) return still_running_problem(id);
    rooms_.log.write(LogLevel::error, "picture_lost", {{"job", id}, {"what", why}});
    const std::optional<JobRecord> record = rooms_.store.get({}, id);
    if (!record) return not_found_problem(id);
    if (record->state == StoredState::expired) return expired_problem(id); // it made room meanwhile
    for (const std::string& asset : record->spec.asset_digests)
        if (!rooms_.blobs.has(BlobStore::Kind::asset, asset)) return picture_lost_problem(id, asset);
    rooms_.blobs.remove(BlobStore::Kind::result, digest); // out of the way of the next one
    rooms_.store.render_again({}, id, digest);            // false: somebody else saw to it
    return renders_again_problem(id);
}

} // namespace server
