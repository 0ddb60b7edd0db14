// The half of ResultKeeper that holds all jobs together to their limit.
#include "server/jobs/result_keeper.h"

#include <algorithm>
#include <set>

namespace server {

namespace {

constexpr BlobStore::Kind kResult = BlobStore::Kind::result;
constexpr std::size_t kAtOnce = 64; // a transaction

} // namespace

std::uint64_t stored_bytes_of(const JobOutcome& outcome)
{
    return (outcome.kept ? outcome.kept->size() : 0) + outcome.result.report_json.size() +
           outcome.result.scene_json.size();
}

std::uint64_t ResultKeeper::used_bytes()
{
    return rooms_.blobs.total_bytes(kResult) + rooms_.store.stored_bytes();
}

bool ResultKeeper::fits(std::uint64_t bytes)
{
    return bytes <= rooms_.most_bytes && used_bytes() <= rooms_.most_bytes - bytes;
}

bool ResultKeeper::make_room(std::uint64_t bytes)
{
    if (fits(bytes)) return true;
    const std::lock_guard results(results_);
    return free_room(bytes);
}

// A little more than asked for, so that not every job that comes pays for one that goes.
bool ResultKeeper::free_room(std::uint64_t bytes)
{
    const std::uint64_t target = bytes + rooms_.most_bytes / 20;
    while (rooms_.store.stored_bytes() + bytes > rooms_.most_bytes / 2 &&
           rooms_.store.forget_ended(kAtOnce) != 0) {
    }
    if (!fits(bytes))
        while (!fits(target) && expire_pictures(target)) {
        }
    while (!fits(bytes) && rooms_.store.forget_ended(kAtOnce) != 0) {
    }
    return fits(bytes);
}

// The rows go first: a picture without a row is collected, a row without its picture would render again.
bool ResultKeeper::expire_pictures(std::uint64_t bytes)
{
    const std::uint64_t newest =
        rooms_.store.newest(); // before the choice: who joins after it saves its picture
    const std::vector<std::string> live_digests = rooms_.live.image_digests();
    const std::set<std::string> live(live_digests.begin(), live_digests.end());
    const std::uint64_t room = rooms_.most_bytes - std::min(bytes, rooms_.most_bytes), used = used_bytes();
    std::uint64_t left = used > room ? used - room : 0;
    std::vector<std::string> chosen;
    for (const std::string& digest : rooms_.blobs.list(kResult)) {
        if (left == 0 || chosen.size() == kAtOnce) break;
        if (live.contains(digest)) continue;
        left -= std::min(left, rooms_.blobs.size(kResult, digest).value_or(0));
        chosen.push_back(digest);
    }
    // Rows whose picture the disk lost take room as well.
    if (left != 0 && chosen.empty())
        for (const std::string& digest : rooms_.store.pictures())
            if (chosen.size() < kAtOnce && !live.contains(digest)) chosen.push_back(digest);
    if (chosen.empty()) return false;
    const std::vector<std::string> expired = rooms_.store.expire_results(chosen, newest);
    for (const std::string& digest : expired)
        rooms_.blobs.remove(kResult, digest);
    rooms_.log.write(
        LogLevel::info, "results_made_room", {{"pictures", static_cast<std::int64_t>(expired.size())}});
    rooms_.live.forget({}); // wakes who waits: a final job changed
    return !expired.empty();
}

} // namespace server
