#include "server/jobs/stored_pictures.h"

#include "server/jobs/job_problems.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace server {

std::variant<JobImage, api::ProblemDetails> StoredPictures::get(const JobId& id, const std::string& digest)
{
    if (PngBytes cached = rooms_.pictures.find(digest)) return JobImage{std::move(cached), digest};
    std::string why_not;
    PngBytes png = read(digest, why_not);
    if (!png) {
        // While this is held no picture comes or goes: what is lost now is lost.
        const auto hold = rooms_.keeper.hold_results();
        png = read(digest, why_not);
        if (!png) return render_again(id, digest, why_not);
    }
    rooms_.pictures.put(digest, png);
    return JobImage{std::move(png), digest};
}

PngBytes StoredPictures::read(const std::string& digest, std::string& why_not)
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
